"""Contexts, which `init` creates and `shutdown` ends."""

from __future__ import annotations

import sys
import threading
import warnings
import weakref
from functools import partial
from inspect import ismethod
from typing import TYPE_CHECKING, Any, Self

from aionode import logging as ros_logging
from rclpy._impl.context import ContextHandle, living_contexts

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from types import MethodType

__all__ = ["Context"]


logging_lock = threading.RLock()
"""Held while a context configures logging, unless another living context has configured it."""


def configure_logging(handle: ContextHandle) -> None:
    """Configure logging from a context's arguments, unless another living context has done it."""
    with logging_lock:
        is_configured = any(context.logs for context in living_contexts())
        handle.logs = True
        if not is_configured:
            arguments = handle.arguments
            ros_logging.configure(
                level=arguments.log_level,
                levels=arguments.log_levels,
                console=arguments.stdout_logs,
                file_name=arguments.log_file_prefix(),
            )


def weakly(method: MethodType, forget: Callable[[], object]) -> Callable[[], None]:
    """Return a function that calls a method while its object lives; `forget` is called at its end.

    Not `weakref.WeakMethod`, which prints an AttributeError at the end of a program if it ends
    before the object. The garbage collector runs `forget` anywhere, so it must not need a lock.
    """
    owner = weakref.ref(method.__self__, lambda _: forget())
    function = weakref.ref(method.__func__, lambda _: forget())  # it may refer to the object

    def call() -> None:
        self, called = owner(), function()
        if self is not None and called is not None:
            called(self)

    return call


class Context:
    """The domain, arguments and end that the nodes of one participant share.

    It can be used once: `init`, then `shutdown` or `try_shutdown`. Its own thread communicates with
    other processes from `init` on; callbacks run in the threads that spin.
    """

    def __init__(self) -> None:
        # Guards the fields below; acquired again by shutdown callbacks, and by nodes that end.
        self._lock = threading.RLock()
        self._callbacks: dict[object, Callable[[], Any]] = {}
        self._handle: ContextHandle | None = None
        self._nodes: list[weakref.ref[Any]] = []

    @property
    def handle(self) -> ContextHandle | None:
        """The handle; None before `init`."""
        return self._handle

    def destroy(self) -> None:
        """Destroy the handle as soon as it is no longer in use."""
        if self._handle is not None:
            self._handle.destroy_when_not_in_use()

    def init(
        self,
        args: Sequence[str] | None = None,
        *,
        initialize_logging: bool = True,
        domain_id: int | None = None,
    ) -> None:
        """Initialise the context: connect to other processes.

        Args:
            args: The command line; `sys.argv` by default.
            initialize_logging: Whether to configure logging from it.
            domain_id: The domain; by default ``ROS_DOMAIN_ID``.

        Raises:
            RuntimeError: it is already initialised, or the domain id is negative.
            UnknownROSArgsError: an argument between ``--ros-args`` and ``--`` is unknown.
            TransportError: no transport can connect.
        """
        with self._lock:
            if domain_id is not None and domain_id < 0:
                raise RuntimeError(f"Domain id ({domain_id}) should not be lower than zero.")
            if self._handle is not None:
                raise RuntimeError("Context.init() must only be called once")
            self._handle = ContextHandle(sys.argv if args is None else args, domain_id)
            if initialize_logging:
                configure_logging(self._handle)

    def track_node(self, node: Any) -> None:
        """Register `node` to be destroyed by `shutdown`, if it still exists then."""
        with self._lock:
            self._nodes.append(weakref.ref(node))

    def untrack_node(self, node: Any) -> None:
        """Undo `track_node`."""
        with self._lock:
            self._nodes = [other for other in self._nodes if other() is not node]

    def ok(self) -> bool:
        """Return whether it is initialised and not shut down."""
        handle = self._handle
        return handle is not None and handle.ok()

    def _cleanup(self) -> None:
        handle = self._handle
        assert handle is not None  # noqa: S101  # checked by the callers
        for reference in list(self._nodes):
            node = reference()
            if node is not None:
                node.destroy_node()
        handle.shutdown()
        callbacks, self._callbacks = self._callbacks, {}
        for callback in list(callbacks.values()):
            callback()
        handle.close()

    def shutdown(self) -> None:
        """Destroy the nodes, send everything they have published, and leave the graph.

        Raises:
            RuntimeError: it was not initialised, or is already shut down.
        """
        if self._handle is None:
            raise RuntimeError("Context must be initialized before it can be shutdown")
        with self._handle, self._lock:
            self._cleanup()

    def try_shutdown(self) -> None:
        """Shut down, unless it already is."""
        if self._handle is None:
            return
        with self._handle, self._lock:
            if self._handle.ok():
                self._cleanup()

    def on_shutdown(self, callback: Callable[[], None]) -> None:
        """Call `callback` at `shutdown`, or now if it is shut down. Methods are held weakly.

        Raises:
            TypeError: it is not callable.
        """
        if not callable(callback):
            raise TypeError("callback should be a callable, got {}", type(callback))
        with self._lock:
            if self._handle is not None and not self._handle.ok():
                callback()
            else:
                key = object()
                if ismethod(callback):
                    callback = weakly(callback, partial(self._callbacks.pop, key, None))
                self._callbacks[key] = callback

    def get_domain_id(self) -> int:
        """Return the domain.

        Raises:
            RuntimeError: it was not initialised.
        """
        if self._handle is None:
            raise RuntimeError("Context must be initialized before it can have a domain id")
        with self._handle:
            return self._handle.get_domain_id()

    def __enter__(self) -> Self:
        if self._handle is None:
            warnings.warn(
                "init() must be called on a Context before using it in a Python context manager. "
                "Calling init() with no arguments, this usage is deprecated",
                stacklevel=2,
            )
            self.init()
        return self

    def __exit__(self, *_: object) -> None:
        self.try_shutdown()
