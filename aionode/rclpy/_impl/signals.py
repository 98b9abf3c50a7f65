"""SIGINT and SIGTERM: they shut contexts down, and then do what they did before."""

from __future__ import annotations

import signal
import weakref
from enum import IntFlag
from functools import partial
from typing import TYPE_CHECKING, Any

from aionode.rclpy._impl.context import living_contexts
from aionode.rclpy._impl.io_thread import postpone
from aionode.rclpy._impl.timers import GuardConditionHandle

if TYPE_CHECKING:
    from types import FrameType

__all__ = [
    "SignalHandlerOptions",
    "current_options",
    "guards",
    "install",
    "uninstall",
]


class SignalHandlerOptions(IntFlag):
    """Which signals are handled."""

    NO = 0
    SIGINT = 1
    SIGTERM = 2
    ALL = 3


SIGNALS = {
    SignalHandlerOptions.SIGINT: signal.SIGINT,
    SignalHandlerOptions.SIGTERM: signal.SIGTERM,
}

replaced: dict[int, Any] = {}
"""By signal: the handler that was there before."""


guards: weakref.WeakSet[GuardConditionHandle] = weakref.WeakSet()
"""What is triggered by each of the signals."""


def current_options() -> SignalHandlerOptions:
    """Return which signals are handled now."""
    options = SignalHandlerOptions.NO
    for option, number in SIGNALS.items():
        if number in replaced:
            options |= option
    return options


def install(options: SignalHandlerOptions) -> None:
    """Handle these signals. In threads other than the main one nothing can be changed."""
    for option, number in SIGNALS.items():
        if option in options and number not in replaced:
            try:
                replaced[number] = signal.signal(number, handle)
            except ValueError:  # not the main thread
                return


def uninstall() -> None:
    """Restore the handlers that were there before."""
    for number, before in list(replaced.items()):
        try:
            if signal.getsignal(number) is handle:
                signal.signal(number, signal.SIG_DFL if before is None else before)
        except ValueError:  # not the main thread
            return
        del replaced[number]


def handle(number: int, frame: FrameType | None) -> None:
    """Shut all contexts down, and call the handler that was there before.

    The default of SIGTERM, which ends the process, is left out: the executors end, and with them
    the program.
    """
    if postpone(partial(handle, number, None)):
        return
    for context in list(living_contexts):
        context.interrupt()
    for guard in list(guards):
        guard.trigger_guard_condition()
    before = replaced.get(number)
    if callable(before):
        before(number, frame)
