"""Timers and rates."""

from aionode.endpoints.timer._rate import Rate
from aionode.endpoints.timer._timer import Timer, TimerCallback, TimerInfo

__all__ = ["Rate", "Timer", "TimerCallback", "TimerInfo"]
