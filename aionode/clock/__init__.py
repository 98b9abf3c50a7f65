"""Time: points, spans, and the clocks that tell and await them.

The only package that reads the clocks of the machine.
"""

from aionode.clock._clocks import (
    Clock,
    ClockChange,
    JumpHandle,
    JumpThreshold,
    ROSClock,
    SteadyClock,
    TimeJump,
)
from aionode.clock._manual import ManualTime
from aionode.clock._time_base import Alarm, MachineTime, TimeBase, perf_ns
from aionode.clock._values import CONST_INFINITE_NS, S_TO_NS, ClockType, Duration, Infinite, Time

__all__ = [
    "CONST_INFINITE_NS",
    "S_TO_NS",
    "Alarm",
    "Clock",
    "ClockChange",
    "ClockType",
    "Duration",
    "Infinite",
    "JumpHandle",
    "JumpThreshold",
    "MachineTime",
    "ManualTime",
    "ROSClock",
    "SteadyClock",
    "Time",
    "TimeBase",
    "TimeJump",
    "perf_ns",
]
