"""Time: points, spans, and the clocks that tell and await them.

The only package that reads the clocks of the machine.
"""

from aionode.clock.base import Alarm, MachineTime, TimeBase, perf_ns
from aionode.clock.clocks import Clock, ROSClock, SteadyClock
from aionode.clock.jumps import ClockChange, JumpHandle, JumpThreshold, TimeJump
from aionode.clock.manual import ManualTime
from aionode.clock.values import CONST_INFINITE_NS, S_TO_NS, ClockType, Duration, Infinite, Time

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
