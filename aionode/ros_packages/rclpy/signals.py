"""SIGINT, SIGTERM and SIGHUP: they shut contexts down, and then call the former handlers."""

from __future__ import annotations

import signal
import weakref
from contextlib import suppress
from enum import Enum, IntFlag
from functools import partial
from typing import TYPE_CHECKING, Any

from aionode.clock import MachineTime
from rclpy._impl.context import living_contexts
from rclpy._impl.timers import GuardConditionHandle
from rclpy._impl.uninterrupted import own_handlers, postpone
from rclpy.guard_condition import GuardCondition

if TYPE_CHECKING:
    from types import FrameType

    from rclpy.context import Context

__all__ = [
    "SignalHandlerGuardCondition",
    "SignalHandlerOptions",
    "get_current_signal_handlers_options",
    "install_signal_handlers",
    "uninstall_signal_handlers",
]


class SignalHandlerOptions(IntFlag):
    """The signals that are handled."""

    NO = 0
    SIGINT = 1
    SIGTERM = 2
    ALL = 3

    __str__ = Enum.__str__  # as rclpy prints it: SignalHandlerOptions.ALL


SIGNALS = {
    SignalHandlerOptions.SIGINT: signal.SIGINT,
    SignalHandlerOptions.SIGTERM: signal.SIGTERM,
}

HANGUP = getattr(signal, "SIGHUP", None)
"""The terminal, or the ssh session, is lost. It ends rclpy's programs without cleanup; here it acts
like SIGTERM, unless the program or ``nohup`` has installed something else."""

AGAIN_S = 1.0
"""How long after a signal a SIGINT counts as part of it, and does not become a KeyboardInterrupt.

A terminal sends its signals to all processes of a group, and those that have started others forward
them. A KeyboardInterrupt would end the cleanup that the first signal began.
"""

steady_ns = MachineTime().steady_ns

replaced: dict[int, Any] = {}
"""By signal: the handler installed before."""


guards: weakref.WeakValueDictionary[int, GuardConditionHandle] = weakref.WeakValueDictionary()
"""The guard conditions triggered by the signals, by their `id`."""


def get_current_signal_handlers_options() -> SignalHandlerOptions:
    """Return the signals that shut contexts down."""
    options = SignalHandlerOptions.NO
    for option, number in SIGNALS.items():
        if number in replaced:
            options |= option
    return options


def install_signal_handlers(options: SignalHandlerOptions = SignalHandlerOptions.ALL) -> None:
    """Install handlers by which these signals shut contexts down.

    SIGINT continues as KeyboardInterrupt in the main thread; SIGTERM makes `spin` return. Only the
    main thread can install handlers; in others nothing happens.
    """
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


def uninstall_signal_handlers() -> None:
    """Restore the former signal handlers."""
    for number, before in list(replaced.items()):
        try:
            if signal.getsignal(number) is handle:
                signal.signal(number, signal.SIG_DFL if before is None else before)
        except ValueError:  # not the main thread
            return
        del replaced[number]


def handle(number: int, frame: FrameType | None) -> None:
    """Shut all contexts down, and call the former handler.

    The default action of SIGTERM and SIGHUP, which ends the process, is omitted: the executors end,
    and with them the program.
    """
    if postpone(partial(handle, number, None)):
        return
    again = is_again()
    contexts = living_contexts()
    for context in contexts:
        context.interrupt()
    for reference in guards.valuerefs():  # not iterated over: other threads may add some meanwhile
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
    """The last signal that did not belong to an earlier one."""

    at_ns: float = float("-inf")


def is_again() -> bool:
    """Return whether a signal belongs to an earlier one; if not, later ones may belong to it."""
    now_ns = steady_ns()
    if now_ns - First.at_ns < AGAIN_S * 1e9:
        return True
    First.at_ns = now_ns
    return False


own_handlers.add(handle)


class SignalHandlerGuardCondition(GuardCondition):
    """A guard condition triggered by a shutdown due to a signal."""

    def __init__(self, context: Context | None = None) -> None:
        super().__init__(callback=None, callback_group=None, context=context)
        guards[id(self.handle)] = self.handle

    def __del__(self) -> None:
        with suppress(Exception):  # it may be destroyed, or only partly created
            self.destroy()

    def destroy(self) -> None:
        """Destroy the guard condition."""
        guards.pop(id(self.handle), None)
        super().destroy()
