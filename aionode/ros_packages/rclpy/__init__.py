"""rclpy's API on aionode, for programs that run on rclpy today.

Its modules and names are rclpy's. `init` starts a thread in which a context of aionode
communicates; executors are plain loops in the threads that spin, so callbacks run only there, and
asyncio stays out of sight. `executors.py` calls every callback.
"""

from __future__ import annotations

from importlib import import_module
from importlib.util import find_spec
from typing import TYPE_CHECKING, Any, Self

from rclpy import context as context
from rclpy import parameter as parameter
from rclpy import signals as signals
from rclpy import task as task
from rclpy import utilities as utilities
from rclpy.context import Context
from rclpy.parameter import Parameter
from rclpy.qos import QoSProfile
from rclpy.signals import (
    SignalHandlerOptions,
    install_signal_handlers,
    uninstall_signal_handlers,
)
from rclpy.task import Future
from rclpy.utilities import (
    get_default_context,
    get_rmw_implementation_identifier,
    ok,
)

if TYPE_CHECKING:
    from types import ModuleType

    from rclpy.executors import Executor
    from rclpy.node import Node

__all__ = [
    "Context",
    "Future",
    "InitContextManager",
    "Parameter",
    "QoSProfile",
    "SignalHandlerOptions",
    "create_node",
    "get_default_context",
    "get_global_executor",
    "get_rmw_implementation_identifier",
    "init",
    "install_signal_handlers",
    "ok",
    "shutdown",
    "spin",
    "spin_once",
    "spin_until_future_complete",
    "try_shutdown",
    "uninstall_signal_handlers",
]


class InitContextManager:
    """The return value of `init`: at the end of ``with`` the context is shut down."""

    def __init__(
        self,
        args: list[str] | None,
        context: Context | None,
        domain_id: int | None,
        signal_handler_options: SignalHandlerOptions | None,
    ) -> None:
        default = get_default_context()
        self.context = default if context is None else context
        if signal_handler_options is None:
            is_default = self.context is default
            signal_handler_options = (
                SignalHandlerOptions.ALL if is_default else SignalHandlerOptions.NO
            )
        self.installed_signal_handlers = signal_handler_options != SignalHandlerOptions.NO
        self.context.init(args, domain_id=domain_id)
        install_signal_handlers(signal_handler_options)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        # Reset to None, so that the next `init` creates a new default context.
        context = None if self.context is get_default_context() else self.context
        try_shutdown(context=context, uninstall_handlers=self.installed_signal_handlers)


def init(
    *,
    args: list[str] | None = None,
    context: Context | None = None,
    domain_id: int | None = None,
    signal_handler_options: SignalHandlerOptions | None = None,
) -> InitContextManager:
    """Initialise a context; everything else requires that.

    Args:
        args: The command line; `sys.argv` by default.
        context: The context; the default one by default.
        domain_id: Its domain; by default ``ROS_DOMAIN_ID``.
        signal_handler_options: Which signals shut contexts down; by default SIGINT and SIGTERM,
            for the default context.

    Returns:
        A context manager that shuts it down.

    Raises:
        RuntimeError: it is already initialised.
    """
    return InitContextManager(args, context, domain_id, signal_handler_options)


_executor: Executor | None = None


def get_global_executor() -> Executor:
    """Return the executor that the functions of this module use: a single-threaded one."""
    global _executor  # noqa: PLW0603  # one for the process, as in rclpy
    if _executor is None:
        from rclpy.executors import SingleThreadedExecutor

        _executor = SingleThreadedExecutor()
        get_default_context().on_shutdown(_reset_executor)
    return _executor


def _reset_executor() -> None:
    global _executor  # one for the process, as in rclpy
    executor, _executor = _executor, None
    if executor is not None:
        executor.shutdown()


def shutdown(*, context: Context | None = None, uninstall_handlers: bool | None = None) -> None:
    """Shut a context down: its nodes are destroyed, and `spin` returns.

    Args:
        context: The context; the default one by default.
        uninstall_handlers: Whether to restore the signal handlers from before `init`; by default
            for the default context.

    Raises:
        RuntimeError: it is not initialised, or already shut down.
    """
    is_default = context is None or context is get_default_context()
    utilities.shutdown(context=context)
    if uninstall_handlers or (uninstall_handlers is None and is_default):
        uninstall_signal_handlers()


def try_shutdown(*, context: Context | None = None, uninstall_handlers: bool | None = None) -> None:
    """Shut a context down, unless it already is; see `shutdown`."""
    is_default = context is None or context is get_default_context()
    utilities.try_shutdown(context=context)
    if uninstall_handlers or (uninstall_handlers is None and is_default):
        uninstall_signal_handlers()


def create_node(node_name: str, **options: Any) -> Node:
    """Return a node; the options are those of `Node`."""
    from rclpy.node import Node

    return Node(node_name, **options)


def spin_once(
    node: Node, *, executor: Executor | None = None, timeout_sec: float | None = None
) -> None:
    """Wait for one callback of a node and call it.

    Args:
        node: The node.
        executor: The executor to use; the global executor by default.
        timeout_sec: Maximum time to wait, in seconds; None or negative for no limit.
    """
    executor = get_global_executor() if executor is None else executor
    added = False
    try:
        added = executor.add_node(node)
        executor.spin_once(timeout_sec=timeout_sec)
    finally:
        if added:
            executor.remove_node(node)


def spin(node: Node, executor: Executor | None = None) -> None:
    """Call the callbacks of a node until its context is shut down.

    Args:
        node: The node.
        executor: The executor to use; the global executor by default.
    """
    executor = get_global_executor() if executor is None else executor
    try:
        executor.add_node(node)
        while executor.context.ok():
            executor.spin_once()
    finally:
        executor.remove_node(node)


def spin_until_future_complete(
    node: Node,
    future: Future[Any],
    executor: Executor | None = None,
    timeout_sec: float | None = None,
) -> None:
    """Call the callbacks of a node until `future` is done.

    Args:
        node: The node.
        future: The future.
        executor: The executor to use; the global executor by default.
        timeout_sec: Maximum time, in seconds; None or negative for no limit.
    """
    executor = get_global_executor() if executor is None else executor
    added = False
    try:
        added = executor.add_node(node)
        executor.spin_until_future_complete(future, timeout_sec)
    finally:
        if added:
            executor.remove_node(node)


def __getattr__(name: str) -> ModuleType:
    """Import a module of rclpy that is named without an import of it.

    Importing one module of ROS's rclpy imports most others, so programs name them all.
    """
    if name.startswith("_") or find_spec(f"{__name__}.{name}") is None:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return import_module(f"{__name__}.{name}")
