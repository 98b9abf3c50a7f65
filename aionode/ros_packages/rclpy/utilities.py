"""The default context, and small functions."""

from __future__ import annotations

import sys
import threading
from typing import TYPE_CHECKING

from aionode import arguments
from rclpy.constants import S_TO_NS
from rclpy.context import Context

if TYPE_CHECKING:
    from collections.abc import Sequence

__all__ = [
    "get_available_rmw_implementations",
    "get_default_context",
    "get_rmw_implementation_identifier",
    "ok",
    "remove_ros_args",
    "shutdown",
    "timeout_sec_to_nsec",
    "try_shutdown",
]

RMW_IDENTIFIER = "rmw_zenoh_cpp"

g_default_context: Context | None = None
# Ensures that there is only one default context at a time.
g_context_lock = threading.RLock()


def get_default_context(*, shutting_down: bool = False) -> Context:
    """Return the default context; with `shutting_down`, the next call returns a new one."""
    global g_default_context  # noqa: PLW0603  # rclpy's
    with g_context_lock:
        context = g_default_context
        if context is None:
            context = g_default_context = Context()
        if shutting_down:
            g_default_context = None
        return context


def remove_ros_args(args: Sequence[str] | None = None) -> list[str]:
    """Return the arguments without those for ROS; by default those of `sys.argv`."""
    return list(arguments.remove_ros_args(sys.argv if args is None else list(args)))


def ok(*, context: Context | None = None) -> bool:
    """Return whether a context, by default the default one, is initialised and not shut down."""
    return (get_default_context() if context is None else context).ok()


def shutdown(*, context: Context | None = None) -> None:
    """Shut a context down, by default the default one.

    Raises:
        RuntimeError: it was not initialised, or is already shut down.
    """
    (get_default_context(shutting_down=True) if context is None else context).shutdown()


def try_shutdown(*, context: Context | None = None) -> None:
    """Shut a context down, by default the default one, unless it already is."""
    global g_default_context  # noqa: PLW0603  # rclpy's
    if context is not None:
        context.try_shutdown()
        return
    default = get_default_context()
    default.try_shutdown()
    with g_context_lock:
        if g_default_context is default and not default.ok():
            g_default_context = None


def get_rmw_implementation_identifier() -> str:
    """Return the middleware whose wire format is used: ``rmw_zenoh_cpp``."""
    return RMW_IDENTIFIER


def get_available_rmw_implementations() -> set[str]:
    """Return the available middlewares: only this one."""
    return {get_rmw_implementation_identifier()}


def timeout_sec_to_nsec(timeout_sec: float | None) -> int:
    """Return a time limit in nanoseconds; -1, meaning forever, if it is None or negative."""
    if timeout_sec is None or timeout_sec < 0:
        return -1
    return int(float(timeout_sec) * S_TO_NS)
