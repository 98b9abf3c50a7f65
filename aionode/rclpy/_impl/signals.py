"""SIGINT, SIGTERM and SIGHUP: they shut contexts down, and then do what they did before."""

from __future__ import annotations

import signal
import weakref
from enum import IntFlag
from functools import partial
from typing import TYPE_CHECKING, Any

from aionode.clock import MachineTime
from aionode.rclpy._impl.context import living_contexts
from aionode.rclpy._impl.timers import GuardConditionHandle
from aionode.rclpy._impl.uninterrupted import own_handlers, postpone

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
    """The signals that are handled."""

    NO = 0
    SIGINT = 1
    SIGTERM = 2
    ALL = 3


SIGNALS = {
    SignalHandlerOptions.SIGINT: signal.SIGINT,
    SignalHandlerOptions.SIGTERM: signal.SIGTERM,
}

HANGUP = getattr(signal, "SIGHUP", None)
"""The terminal, or the session of ssh, is lost. rclpy's programs end by it without cleanup; here it
is a second SIGTERM, unless the program or ``nohup`` has made something else of it.
"""

AGAIN_S = 1.0
"""For how long after a signal a SIGINT belongs to it, and becomes no KeyboardInterrupt.

A terminal sends its signals to all processes of a group, and those that have started others forward
them. A KeyboardInterrupt would end the cleanup that the first signal began.
"""

steady_ns = MachineTime().steady_ns

replaced: dict[int, Any] = {}
"""By signal: the handler that was there before."""


guards: weakref.WeakValueDictionary[int, GuardConditionHandle] = weakref.WeakValueDictionary()
"""The guard conditions that each of the signals triggers, by their `id`."""


def current_options() -> SignalHandlerOptions:
    """Return which signals are handled now."""
    options = SignalHandlerOptions.NO
    for option, number in SIGNALS.items():
        if number in replaced:
            options |= option
    return options


def install(options: SignalHandlerOptions) -> None:
    """Handle these signals. In threads other than the main one nothing can be changed."""
    numbers = [number for option, number in SIGNALS.items() if option in options]
    if (
        SignalHandlerOptions.SIGTERM in options
        and HANGUP is not None
        and signal.getsignal(HANGUP) is signal.SIG_DFL
    ):
        numbers.append(HANGUP)
    for number in numbers:
        if number not in replaced:
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

    The default of SIGTERM and SIGHUP, which ends the process, is left out: the executors end, and
    with them the program.
    """
    if postpone(partial(handle, number, None)):
        return
    again = is_again()
    contexts = living_contexts()
    for context in contexts:
        context.interrupt()
    for reference in guards.valuerefs():  # not iterated over: other threads add some meanwhile
        guard = reference()
        if guard is not None:
            guard.trigger_guard_condition()
    before = replaced.get(number)
    if not callable(before) or (before is signal.default_int_handler and again):
        return
    try:
        before(number, frame)
    except BaseException:
        for context in contexts:
            context.note_told()
        raise


class First:
    """The last signal that did not belong to one before."""

    at_ns: float = float("-inf")


def is_again() -> bool:
    """Return whether a signal belongs to one before; if not, others belong to it from now on."""
    now_ns = steady_ns()
    if now_ns - First.at_ns < AGAIN_S * 1e9:
        return True
    First.at_ns = now_ns
    return False


own_handlers.add(handle)
