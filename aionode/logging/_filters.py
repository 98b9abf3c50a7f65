"""Filters for repeated log calls: once, skip_first, throttle.

Their state belongs to the call site: the place in the code that calls the logger. Two calls on one
line are two call sites.
"""

from __future__ import annotations

from collections.abc import Callable
from types import CodeType, FrameType
from typing import TYPE_CHECKING, TypedDict

from aionode.clock import S_TO_NS
from aionode.errors import brief

if TYPE_CHECKING:
    from aionode.clock import Clock

__all__ = ["CallSite", "CallSites", "LogOptions"]


class LogOptions(TypedDict, total=False):
    """The keyword arguments that every logging method takes.

    Attributes:
        name: Log under this name instead of the logger's.
        once: Log only the first message of this call site.
        skip_first: Log all messages but the first.
        throttle_duration_sec: Log at most one message in this many seconds.
        throttle_time_source_type: The clock for throttling; the system clock by default.
    """

    name: str | None
    once: bool
    skip_first: bool
    throttle_duration_sec: float
    throttle_time_source_type: Clock


FILTERS = ("throttle_duration_sec", "throttle_time_source_type", "skip_first", "once")


class CallSite:
    """One place in the code that logs, with the state of its filters."""

    __slots__ = ("code", "last_ns", "logged", "name", "options", "skipped")

    def __init__(self, code: CodeType, name: str, options: LogOptions) -> None:
        # Keeps the code object alive, as its id is part of the key and must not be reused.
        self.code = code
        self.name = name
        self.options = checked(options)
        self.last_ns = 0
        self.skipped = False
        self.logged = False

    def check(self, name: str, options: LogOptions) -> None:
        """Reject a call whose options differ from those of the first call at this call site.

        Raises:
            ValueError: Name or filters are not those of the first call.
        """
        if name != self.name:
            message = "Logger name cannot be changed between calls."
            raise ValueError(message)
        if not options and not self.options:
            return
        options = checked(options)
        if options.keys() != self.options.keys():
            message = "Requested logging filters cannot be changed between calls."
            raise ValueError(message)
        if options != self.options:
            message = "Logging filter parameters cannot be changed between calls."
            raise ValueError(message)

    def lets_through(self, now_ns: Callable[[], int]) -> bool:
        """Return whether to log this message, and update the state.

        A filter that drops a message does not update the filters after it: with throttle and once,
        the message that is logged is the first one to pass throttle.
        """
        options = self.options
        if "throttle_duration_sec" in options and not self._throttle(now_ns):
            return False
        if "skip_first" in options and not self.skipped:
            self.skipped = True
            return False
        if "once" in options:
            if self.logged:
                return False
            self.logged = True
        return True

    def _throttle(self, now_ns: Callable[[], int]) -> bool:
        clock = self.options.get("throttle_time_source_type")
        now = now_ns() if clock is None else clock.now().nanoseconds
        period_ns = self.options["throttle_duration_sec"] * S_TO_NS
        # A clock that jumps back, as when a simulation restarts, must not silence the call site.
        if self.last_ns <= now < self.last_ns + period_ns:
            return False
        self.last_ns = now
        return True


def checked(options: LogOptions) -> LogOptions:
    """Return the filters that `options` turn on.

    Raises:
        TypeError: An option is unknown, or lacks another one.
        ValueError: `throttle_time_source_type` is not a clock.
    """
    for option in options:
        if option not in FILTERS:
            # The error that Python raises for an argument which the method already fixes.
            message = f"got multiple values for argument {brief(option)}"
            if option == "severity":
                raise TypeError(message)
            message = (
                f"parameter {brief(option)} is not one of the recognized logging options {FILTERS}"
            )
            raise TypeError(message)
    clock: object = options.get("throttle_time_source_type")
    if clock is not None and not callable(getattr(clock, "now", None)):
        message = f"Received throttle_time_source_type of {brief(clock)} is not a clock instance"
        raise ValueError(message)
    if clock is not None and "throttle_duration_sec" not in options:
        message = "required parameter 'throttle_duration_sec' not specified but is required for "
        raise TypeError(message + "throttle_time_source_type")
    return {option: value for option, value in options.items() if value}  # type: ignore[return-value]  # a subset


class CallSites:
    """The call sites of one logger."""

    __slots__ = ("_sites",)

    def __init__(self) -> None:
        self._sites: dict[tuple[int, int, int], CallSite] = {}

    def find(self, frame: FrameType, severity: int, name: str, options: LogOptions) -> CallSite:
        """Return the call site of `frame`: created on its first call, checked on later ones."""
        # `(log.info if ok else log.error)(…)` is one place in the code but two calls, so the
        # filters keep state per severity. rclpy rejects the second at run time.
        key = (id(frame.f_code), frame.f_lasti, severity)
        site = self._sites.get(key)
        if site is None:
            site = self._sites[key] = CallSite(frame.f_code, name, options)
        else:
            site.check(name, options)
        return site
