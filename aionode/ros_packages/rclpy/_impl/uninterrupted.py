"""Work of a context's thread that other threads do, and that nothing may interrupt.

A handler of a signal runs in the main thread, between any two bytecodes. It may use the objects
that the thread is just using, and it may raise, so that the work it has interrupted stays half
done. Finalizers, which the garbage collector calls in any thread, never raise, but use objects too.

So three rules hold. The main thread does such work only while the program has installed no handler
in Python; else the context's own thread does it. rclpy's own handler puts itself off until the end
of the work. And within the work nothing waits: a finalizer that publishes leaves its message to the
context's thread, and one that asks gets an error.
"""

from __future__ import annotations

import signal

# `signal.getsignal` makes an enum of each answer, which takes ten times as long.
from _signal import getsignal  # type: ignore[import-not-found]  # it has no stub
from threading import current_thread, get_ident, local, main_thread
from typing import TYPE_CHECKING, Any

from rclpy._impl.errors import RCLError

if TYPE_CHECKING:
    from collections.abc import Callable

__all__ = ["begin", "current", "end", "own_handlers", "postpone", "postponed", "refuse_to_wait"]

UNCATCHABLE = {getattr(signal, name, None) for name in ("SIGKILL", "SIGSTOP")}

NUMBERS = sorted(int(number) for number in signal.valid_signals() if number not in UNCATCHABLE)


class Uninterrupted(local):
    """Such work of this thread.

    Attributes:
        active: Whether it does any, or looks whether it may.
        begun: Whether it does any.
        rouse: Ends the wait that is part of it, if one is.
    """

    active = False
    begun = False
    rouse: Callable[[], None] | None = None


current = Uninterrupted()

own_handlers: set[Any] = set()
"""The handlers of signals that call `postpone` first."""

postponed: list[Callable[[], object]] = []
"""Work of signal handlers that is due once the main thread has left its uninterrupted work."""


class Handlers:
    """The handlers that were installed at the last look, and whether all are harmless."""

    seen: list[Any] | None = None
    harmless = False


def begin() -> bool:
    """Begin work that nothing may interrupt; then `end` has to follow.

    Returns:
        Whether it may be done in this thread: not in a finalizer that interrupts such work, and not
        where a handler of the program may interrupt it.
    """
    if current.active:
        return False
    # Before the look: rclpy's handler puts itself off from here on, and with it the program's code
    # that it calls and that might install another one.
    current.active = True
    alone = False
    try:
        alone = get_ident() != main_thread().ident or handlers_are_harmless()
    finally:
        # A handler of the program that interrupts the look may wait: the work does not begin then.
        current.begun = alone
        if not alone:
            current.active = False
    if not alone and postponed:
        call_postponed()
    return alone


def end() -> None:
    """End it, and call what was put off meanwhile."""
    current.rouse = None
    current.begun = current.active = False
    if postponed:
        call_postponed()


def handlers_are_harmless() -> bool:
    """Return whether no handler in Python is installed but those that call `postpone`."""
    installed = [*map(getsignal, NUMBERS)]
    if installed != Handlers.seen:
        Handlers.harmless = all(
            handler in own_handlers for handler in installed if callable(handler)
        )
        Handlers.seen = installed
    return Handlers.harmless


def postpone(action: Callable[[], object]) -> bool:
    """Postpone `action` if this thread does such work, and call it soon after.

    Returns:
        Whether it will be called.
    """
    if not current.active:
        return False
    postponed.append(action)
    if current.rouse is not None:
        current.rouse()
    return True


def call_postponed() -> None:
    """Call what `postpone` has kept, in the thread that handles signals."""
    while postponed and current_thread() is main_thread():
        postponed.pop(0)()


def refuse_to_wait() -> None:
    """Raise within such work, whose end the wait would wait for.

    Raises:
        RCLError: it is under way in this thread: a finalizer has interrupted it.
    """
    if current.begun:
        raise RCLError(
            "a finalizer interrupted a thread that sends or receives, and cannot wait for an "
            "answer; publish there, or ask later, in a callback"
        )
