"""Timers and rates."""

from aionode.endpoints.timer._rate import Rate
from aionode.endpoints.timer._timer import (
    Timer,
    TimerCallback,
    TimerInfo,
    to_period_ns,
)

__all__ = ["Rate", "Timer", "TimerCallback", "TimerInfo", "to_period_ns"]
