"""Time: points, spans, and the clocks that tell and await them.

The only package that reads the clocks of the machine.
"""

from aionode.clock.base import Alarm, MachineTime, TimeBase, perf_ns
from aionode.clock.values import CONST_INFINITE_NS, S_TO_NS, ClockType, Duration, Infinite, Time

__all__ = [
    "CONST_INFINITE_NS",
    "S_TO_NS",
    "Alarm",
    "ClockType",
    "Duration",
    "Infinite",
    "MachineTime",
    "Time",
    "TimeBase",
    "perf_ns",
]
