"""Points in time, durations, and clocks that can be read and awaited.

No other package reads the machine's clocks.
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
from aionode.clock._silence import SilenceAlarm
from aionode.clock._time_base import (
    Alarm,
    MachineTime,
    TimeBase,
    perf_ns,
    process_ns,
    thread_ns,
    thread_waited_ns,
)
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
    "ROSClock",
    "SilenceAlarm",
    "SteadyClock",
    "Time",
    "TimeBase",
    "TimeJump",
    "perf_ns",
    "process_ns",
    "thread_ns",
    "thread_waited_ns",
]
