"""The handle of a context: its arguments, and the thread in which it communicates."""

from __future__ import annotations

import atexit
import os
import weakref
from threading import get_ident
from typing import TYPE_CHECKING

from aionode import Context
from aionode.arguments import Arguments, parse_arguments
from aionode.clock import MachineTime
from aionode.engine.transport import send_thread as _send_thread  # noqa: F401  # for the order, see `close_all`
from aionode.errors import InvalidROSArgsError
from rclpy._impl.destroyable import Destroyable
from rclpy._impl.errors import (
    InvalidHandle,
    RCLError,
    RCLInvalidROSArgsError,
    UnknownROSArgsError,
)
from rclpy._impl.io_thread import IoThread

if TYPE_CHECKING:
    from collections.abc import Sequence

__all__ = ["LAST_CALL_S", "ContextHandle", "contexts_by_id", "living_contexts", "parsed"]

contexts_by_id: weakref.WeakValueDictionary[int, ContextHandle] = weakref.WeakValueDictionary()

LAST_WORDS_S = 2.0
"""How long a thread may still publish after a signal has shut its context down."""

LAST_CALL_S = 1.0
"""How long it waits for a response then; it may have to publish, too."""

steady_ns = MachineTime().steady_ns


def living_contexts() -> list[ContextHandle]:
    """Return the contexts that are not shut down; any thread or signal handler may call this."""
    # Not iterated over, because other threads may create contexts meanwhile.
    contexts = [reference() for reference in contexts_by_id.valuerefs()]
    return [context for context in contexts if context is not None]


def parsed(args: Sequence[str]) -> Arguments:
    """Return the ROS arguments of a command line.

    Raises:
        UnknownROSArgsError: one is unknown.
        RCLInvalidROSArgsError: one is malformed.
        UnicodeEncodeError: one is not text.
    """
    for arg in args:
        arg.encode()
    try:
        arguments = parse_arguments(list(args))
    except InvalidROSArgsError as error:
        raise RCLInvalidROSArgsError(f"Failed to parse ROS arguments: {error}") from error
    if arguments.unparsed_ros_args:
        raise UnknownROSArgsError(
            f"Found unknown ROS arguments: {list(arguments.unparsed_ros_args)}"
        )
    return arguments


class ContextHandle(Destroyable):
    """An initialised context. `signal` is woken when it is shut down.

    Args:
        args: The command line.
        domain_id: The domain, or None for that of the environment.

    Attributes:
        io: The thread that works for it.
        arguments: Its ROS arguments.
        is_shut_down: Whether it is shut down.
        logs: Whether it has configured logging, or found it configured.

    Raises:
        UnknownROSArgsError: an argument between ``--ros-args`` and ``--`` is unknown.
        RCLInvalidROSArgsError: an argument is malformed.
        TransportError: a transport cannot connect.
    """

    def __init__(self, args: Sequence[str], domain_id: int | None) -> None:
        super().__init__()
        # Flags that change from False to True once, in any thread or signal handler.
        self.is_shut_down = False
        self.logs = False
        self._closed = False
        self._signalled = False
        self._told_ns: dict[int, int] = {}  # by thread: when it learned of the signal
        arguments = parsed(args)
        context = Context(domain_id=domain_id)
        context.arguments = arguments
        self.arguments = arguments
        self.io = IoThread(context)
        self.io.start()
        contexts_by_id[id(self)] = self

    def ok(self) -> bool:
        """Return whether it is not shut down."""
        if self.is_shut_down:
            self.note_told()
            return False
        return True

    def note_told(self) -> None:
        """Record that this thread of the program has learned of the shutdown."""
        if self._signalled:
            self._told_ns.setdefault(get_ident(), steady_ns())

    def refuse_to_publish(self) -> None:
        """Raise after shutdown, unless a signal caused it, and the message is a last word.

        A robot is stopped by a message that many programs publish at their end: in a ``finally``,
        or after `spin`. With rclpy that is too late, because the signal has already shut the
        context down. Here a thread may publish for a while after it has learned of the shutdown: by
        an exception, the end of a wait, or `ok`. It may not before, because messages published
        then, in a loop, belong to the work that the signal is meant to end.

        Raises:
            RCLError: it is shut down.
        """
        if self.is_shut_down:
            told_ns = self._told_ns.get(get_ident())
            if self._closed or told_ns is None or steady_ns() - told_ns > LAST_WORDS_S * 1e9:
                self.refuse_after_shutdown("Failed to publish", "publisher")

    def get_domain_id(self) -> int:
        """Return the ROS domain."""
        return self.io.context.domain_id

    def refuse_if_over(self, wanted: str) -> None:
        """Raise if nothing can be created in this context any more.

        Raises:
            InvalidHandle: it is destroyed.
            RCLError: it is shut down.
            ForkedProcessError: it belongs to the parent of this forked process.
        """
        if not self.is_valid:
            raise InvalidHandle("cannot use Destroyable because destruction was requested")
        if not self.ok():
            self.io.refuse_if_inherited()
            raise RCLError(
                f"failed to create {wanted}: the given context is not valid, either rcl_init() "
                "was not called or rcl_shutdown() was called."
            )

    def refuse_after_shutdown(self, failure: str, user: str = "rcl node") -> None:
        """Raise rcl's error after shutdown, which ends programs that retry in a loop.

        Args:
            failure: What fails.
            user: What uses the context.

        Raises:
            RCLError: it is shut down.
            ForkedProcessError: it belongs to the parent of this forked process.
        """
        if not self.ok():
            self.io.refuse_if_inherited()
            raise RCLError(f"{failure}: {user}'s context is invalid")

    def mark_shut_down(self) -> None:
        """Shut down as far as a signal handler may: without locks or waiting."""
        self.is_shut_down = True
        self.signal.notify()

    def interrupt(self) -> None:
        """Shut down from a signal handler.

        `shutdown` is still possible afterwards, and never refused.
        """
        self._signalled = True
        self.mark_shut_down()

    def shutdown(self) -> None:
        """Shut down: executors stop spinning.

        Raises:
            RuntimeError: it is already shut down, other than by a signal.
        """
        if self._closed and not self._signalled:
            raise RuntimeError("Context already shutdown.")
        self._closed = True
        self.mark_shut_down()
        contexts_by_id.pop(id(self), None)

    def close(self) -> None:
        """Send everything published, leave the graph, and end the thread."""
        self.io.stop()

    def _destroy(self) -> None:
        self.is_shut_down = True
        if hasattr(self, "io"):
            self.io.stop()


# Called before `_send_thread` ends the sending threads, because that module is imported above:
# functions registered last are called first.
@atexit.register
def close_all() -> None:
    """Send what a program has published that ends without `shutdown`.

    The contexts are not shut down: daemon threads spin until the process ends, as in rclpy, and
    nothing that they still publish is sent.
    """
    for context in living_contexts():
        context.close()


def abandon_all() -> None:
    """Leave all contexts to the parent. Called in a forked child before anything else runs."""
    for context in living_contexts():
        context.is_shut_down = True
        context.io.abandon()


if hasattr(os, "register_at_fork"):  # not on Windows
    os.register_at_fork(after_in_child=abandon_all)
