"""The handle of a context: its arguments, and the thread in which it talks to others."""

from __future__ import annotations

import atexit
import weakref
from typing import TYPE_CHECKING

from aionode import Context
from aionode.arguments import Arguments, parse_arguments
from aionode.errors import InvalidROSArgsError
from aionode.rclpy._impl.destroyable import Destroyable
from aionode.rclpy._impl.errors import (
    InvalidHandle,
    RCLError,
    RCLInvalidROSArgsError,
    UnknownROSArgsError,
)
from aionode.rclpy._impl.io_thread import IoThread

if TYPE_CHECKING:
    from collections.abc import Sequence

__all__ = ["ContextHandle", "living_contexts", "parsed"]

living_contexts: weakref.WeakSet[ContextHandle] = weakref.WeakSet()
"""Those that are not shut down, for signal handlers."""


def parsed(args: Sequence[str]) -> Arguments:
    """Return the ROS arguments of a command line.

    Raises:
        UnknownROSArgsError: one is unknown.
        RCLInvalidROSArgsError: one is malformed.
        UnicodeEncodeError: one is no text.
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
    """A context that is initialised. `signal` is woken by its shutdown.

    Args:
        args: The command line.
        domain_id: The domain, or None for that of the environment.

    Attributes:
        io: The thread that works for it.
        arguments: Its ROS arguments.
        is_shut_down: Whether it is shut down.

    Raises:
        UnknownROSArgsError: an argument between ``--ros-args`` and ``--`` is unknown.
        RCLInvalidROSArgsError: an argument is malformed.
        TransportError: a transport cannot connect.
    """

    def __init__(self, args: Sequence[str], domain_id: int | None) -> None:
        super().__init__()
        self.is_shut_down = False
        self._closed = False
        self._signalled = False
        arguments = parsed(args)
        context = Context(domain_id=domain_id)
        context.arguments = arguments
        self.arguments = arguments
        self.io = IoThread(context)
        self.io.start()
        living_contexts.add(self)

    def ok(self) -> bool:
        """Return whether it is not shut down."""
        return not self.is_shut_down

    def get_domain_id(self) -> int:
        """Return the ROS domain."""
        return self.io.context.domain_id

    def refuse_if_over(self, wanted: str) -> None:
        """Raise unless something can still be made in this context.

        Raises:
            InvalidHandle: it is destroyed.
            RCLError: it is shut down.
        """
        if not self.is_valid:
            raise InvalidHandle("cannot use Destroyable because destruction was requested")
        if self.is_shut_down:
            raise RCLError(
                f"failed to create {wanted}: the given context is not valid, either rcl_init() "
                "was not called or rcl_shutdown() was called."
            )

    def refuse_after_shutdown(self, failure: str, user: str = "rcl node") -> None:
        """Raise after shutdown, in rcl's words: a program that asks in a loop ends by that.

        Args:
            failure: What fails.
            user: What uses the context.

        Raises:
            RCLError: it is shut down.
        """
        if self.is_shut_down:
            raise RCLError(f"{failure}: {user}'s context is invalid")

    def mark_shut_down(self) -> None:
        """Shut down as far as a signal handler may: no lock is taken, nothing is waited for."""
        self.is_shut_down = True
        self.signal.notify()

    def interrupt(self) -> None:
        """Shut down from a signal handler. `shutdown` is still possible, and never refused."""
        self._signalled = True
        self.mark_shut_down()

    def shutdown(self) -> None:
        """Shut down: executors stop to spin.

        Raises:
            RuntimeError: it is shut down already, other than by a signal.
        """
        if self._closed and not self._signalled:
            raise RuntimeError("Context already shutdown.")
        self._closed = True
        self.mark_shut_down()
        living_contexts.discard(self)

    def close(self) -> None:
        """Send what was published, leave the graph, and end the thread."""
        self.io.stop()

    def _destroy(self) -> None:
        self.is_shut_down = True
        if hasattr(self, "io"):
            self.io.stop()


@atexit.register
def close_all() -> None:
    """Send what a program has published that ends without `shutdown`."""
    for context in list(living_contexts):
        context.mark_shut_down()
        context.close()
