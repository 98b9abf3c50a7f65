"""Work of a context's thread that other threads do, and that nothing may interrupt.

A signal handler runs in the main thread, between any two bytecodes. It may use the objects that the
thread is just using, and it may raise, so that the interrupted work stays half done. Finalizers,
which the garbage collector calls in any thread, never raise, but use objects as well.

Hence three rules. The main thread does such work only while the program has installed no signal
handler in Python; otherwise the context's own thread does it. rclpy's own handler postpones itself
until the end of the work. And nothing waits within the work: a finalizer that publishes leaves its
message to the context's thread, and one that waits for an answer gets an error.
"""

from __future__ import annotations

import os
import signal

# `signal.getsignal` creates an enum for each answer, which takes ten times as long.
from _signal import getsignal  # type: ignore[import-not-found]  # it has no stub
from threading import current_thread, get_ident, main_thread
from typing import TYPE_CHECKING, Any

from rclpy._impl.errors import RCLError

if TYPE_CHECKING:
    from collections.abc import Callable

__all__ = ["begin", "begun", "end", "own_handlers", "postpone", "postponed", "refuse_to_wait"]

UNCATCHABLE = {getattr(signal, name, None) for name in ("SIGKILL", "SIGSTOP")}

NUMBERS = sorted(int(number) for number in signal.valid_signals() if number not in UNCATCHABLE)


def looks() -> None:
    """Stand for what ends the wait of a thread that checks whether it may do such work."""


working: dict[int, Callable[[], None] | None] = {}
"""The threads that do such work, or check whether they may, and what ends the wait of each."""

own_handlers: set[Any] = set()
"""The handlers of signals that call `postpone` first."""

postponed: list[Callable[[], object]] = []
"""Work of signal handlers that is due once the main thread has left its uninterrupted work."""


class Handlers:
    """The installed handlers at the last check, whether all of them are harmless, and their thread.

    Attributes:
        thread: The main thread, in which Python calls them.
    """

    seen: list[Any] | None = None
    harmless = False
    thread = main_thread().ident


def begin(rouse: Callable[[], None] | None = None) -> bool:
    """Begin work that nothing may interrupt; `end` has to follow.

    Args:
        rouse: Ends the wait within the work, if there is one.

    Returns:
        Whether it may be done in this thread: not in a finalizer that interrupts such work, and not
        where a handler of the program may interrupt it.
    """
    ident = get_ident()
    if ident in working:
        return False
    alone = False
    try:
        # Before the check: from here on rclpy's handler postpones itself, and with it the program's
        # code that it calls and that might install another handler.
        working[ident] = looks
        alone = ident != Handlers.thread or handlers_are_harmless()
    finally:
        # A handler of the program that interrupts the check may wait: the work does not begin then.
        if alone:
            working[ident] = rouse
        else:
            working.pop(ident, None)
    if not alone and postponed:
        call_postponed()
    return alone


def begun() -> bool:
    """Return whether this thread does such work."""
    return working.get(get_ident(), looks) is not looks


def end() -> None:
    """End the work, and call what was postponed meanwhile."""
    working.pop(get_ident(), None)
    if postponed:
        call_postponed()


def handlers_are_harmless() -> bool:
    """Return whether all installed Python handlers are ones that call `postpone`."""
    installed = [*map(getsignal, NUMBERS)]
    if installed != Handlers.seen:
        Handlers.harmless = all(
            handler in own_handlers for handler in installed if callable(handler)
        )
        Handlers.seen = installed
    return Handlers.harmless


def note_main_thread() -> None:
    """Note the main thread; called in a forked child, where it is the one that has forked."""
    Handlers.thread = main_thread().ident
    for ident in working.keys() - {Handlers.thread}:
        del working[ident]


if hasattr(os, "register_at_fork"):  # not on Windows
    os.register_at_fork(after_in_child=note_main_thread)  # after that of `threading`


def postpone(action: Callable[[], object]) -> bool:
    """Postpone `action` until soon after this thread's uninterrupted work, if it does any.

    Returns:
        Whether it will be called.
    """
    ident = get_ident()
    if ident not in working:
        return False
    postponed.append(action)
    rouse = working[ident]
    if rouse is not None:
        rouse()
    return True


def call_postponed() -> None:
    """Call the postponed actions, in the thread that handles signals."""
    while postponed and current_thread() is main_thread():
        postponed.pop(0)()


def refuse_to_wait() -> None:
    """Raise within such work, for whose end the wait would wait.

    Raises:
        RCLError: it is in progress in this thread: a finalizer has interrupted it.
    """
    if begun():
        raise RCLError(
            "a finalizer interrupted a thread that sends or receives, and cannot wait for an "
            "answer; publish there, or wait later, in a callback"
        )
