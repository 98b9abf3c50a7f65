"""Callbacks for changes of single parameters, of any node."""

from __future__ import annotations

from collections import defaultdict
from itertools import chain
from threading import RLock
from typing import TYPE_CHECKING, Any

from rclpy._impl import messages as msg
from rclpy.qos import QoSProfile, qos_profile_parameter_events

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence

    from rclpy.callback_groups import CallbackGroup
    from rclpy.event_handler import SubscriptionEventCallbacks
    from rclpy.node import Node
    from rclpy.qos_overriding_options import QoSOverridingOptions

__all__ = ["ParameterCallbackHandle", "ParameterEventCallbackHandle", "ParameterEventHandler"]

GONE = "Callback doesn't exist"


class ParameterCallbackHandle:
    """A callback for one parameter of one node."""

    def __init__(self, parameter_name: str, node_name: str, callback: Callable[[Any], Any]) -> None:
        self.parameter_name = parameter_name
        self.node_name = node_name
        self.callback = callback
        self.mutex = RLock()


class ParameterEventCallbackHandle:
    """A callback for all events."""

    def __init__(self, callback: Callable[[Any], Any]) -> None:
        self.callback = callback
        self.mutex = RLock()


class ParameterEventHandler:
    """Calls callbacks for changes of parameters.

    Args:
        node: The node that subscribes to the events; names are relative to it.
        qos_profile: QoS of the subscription.
        callback_group: The group of its callback.
        event_callbacks: Callbacks for events of the subscription itself.
        qos_overriding_options: Which policies parameters may override.
        raw: Whether events are delivered as bytes, which only event callbacks accept.
    """

    class Callbacks:
        """The callbacks; the newest of each kind is called first."""

        def __init__(self) -> None:
            self.parameter_callbacks: dict[tuple[str, str], list[ParameterCallbackHandle]] = (
                defaultdict(list)
            )
            self.event_callbacks: list[ParameterEventCallbackHandle] = []
            self.mutex = RLock()

        def event_callback(self, event: Any) -> None:
            """Call the callbacks that an event concerns."""
            with self.mutex:
                for (name, node_name), handles in self.parameter_callbacks.items():
                    parameter = ParameterEventHandler.get_parameter_from_event(
                        event, parameter_name=name, node_name=node_name
                    )
                    if parameter is not None:
                        for handle in handles:
                            with handle.mutex:
                                handle.callback(parameter)
                for event_handle in self.event_callbacks:
                    with event_handle.mutex:
                        event_handle.callback(event)

        def add_parameter_callback(
            self, parameter_name: str, node_name: str, callback: Callable[[Any], Any]
        ) -> ParameterCallbackHandle:
            """Add a callback for a parameter."""
            handle = ParameterCallbackHandle(parameter_name, node_name, callback)
            with self.mutex:
                self.parameter_callbacks[parameter_name, node_name].insert(0, handle)
            return handle

        def remove_parameter_callback(self, handle: ParameterCallbackHandle) -> None:
            """Remove a callback; raise RuntimeError if it was not added."""
            key = (handle.parameter_name, handle.node_name)
            with self.mutex:
                if handle not in self.parameter_callbacks.get(key, ()):
                    raise RuntimeError(GONE)
                self.parameter_callbacks[key].remove(handle)
                if not self.parameter_callbacks[key]:
                    del self.parameter_callbacks[key]

        def add_parameter_event_callback(
            self, callback: Callable[[Any], Any]
        ) -> ParameterEventCallbackHandle:
            """Add a callback for all events."""
            handle = ParameterEventCallbackHandle(callback)
            with self.mutex:
                self.event_callbacks.insert(0, handle)
            return handle

        def remove_parameter_event_callback(self, handle: ParameterEventCallbackHandle) -> None:
            """Remove a callback; raise RuntimeError if it was not added."""
            with self.mutex:
                if handle not in self.event_callbacks:
                    raise RuntimeError(GONE)
                self.event_callbacks.remove(handle)

    def __init__(
        self,
        node: Node,
        qos_profile: QoSProfile = qos_profile_parameter_events,
        callback_group: CallbackGroup | None = None,
        event_callbacks: SubscriptionEventCallbacks | None = None,
        qos_overriding_options: QoSOverridingOptions | None = None,
        raw: bool = False,
    ) -> None:
        self.node = node
        self.qos_profile = qos_profile
        self._callbacks = ParameterEventHandler.Callbacks()
        self.parameter_event_subscription = node.create_subscription(
            msg.ParameterEvent,
            "/parameter_events",
            self._callbacks.event_callback,
            qos_profile,
            callback_group=callback_group,
            event_callbacks=event_callbacks,
            qos_overriding_options=qos_overriding_options,
            raw=raw,
        )

    def destroy(self) -> None:
        """Stop calling callbacks."""
        self.node.destroy_subscription(self.parameter_event_subscription)

    @staticmethod
    def get_parameter_from_event(event: Any, parameter_name: str, node_name: str) -> Any | None:
        """Return a parameter that an event reports as new or changed, or None."""
        if event.node != node_name:
            return None
        for parameter in ParameterEventHandler.get_parameters_from_event(event):
            if parameter.name == parameter_name:
                return parameter
        return None

    @staticmethod
    def get_parameters_from_event(event: Any) -> Iterable[Any]:
        """Yield the parameters that an event reports as new or changed."""
        yield from chain(event.new_parameters, event.changed_parameters)

    def add_parameter_callback(
        self, parameter_name: str, node_name: str, callback: Callable[[Any], Any]
    ) -> ParameterCallbackHandle:
        """Call `callback` with each new value of a parameter, as a message.

        Args:
            parameter_name: The parameter.
            node_name: Its node; an empty name means this node, a relative one is in its namespace.
            callback: Called with the message.
        """
        return self._callbacks.add_parameter_callback(
            parameter_name, self._resolve_path(node_name), callback
        )

    def remove_parameter_callback(self, handle: ParameterCallbackHandle) -> None:
        """Remove a callback; raise RuntimeError if it was not added."""
        self._callbacks.remove_parameter_callback(handle)

    def add_parameter_event_callback(
        self, callback: Callable[[Any], Any]
    ) -> ParameterEventCallbackHandle:
        """Call `callback` with each event of any node."""
        return self._callbacks.add_parameter_event_callback(callback)

    def remove_parameter_event_callback(self, handle: ParameterEventCallbackHandle) -> None:
        """Remove a callback; raise RuntimeError if it was not added."""
        self._callbacks.remove_parameter_event_callback(handle)

    def configure_nodes_filter(self, node_names: Sequence[str] | None = None) -> bool:
        """Receive only events of some nodes, or of all without names; as in rclpy of Lyrical.

        Args:
            node_names: Their full names, with namespace.

        Returns:
            Whether the filter was set or removed.
        """
        names = list(node_names or ())
        expression = " OR ".join(f"node = %{at}" for at in range(len(names)))
        subscription = self.parameter_event_subscription
        subscription.set_content_filter(expression, [f"'{name}'" for name in names])
        return subscription.is_cft_enabled == bool(names)

    def _resolve_path(self, node_path: str | None = None) -> str:
        if not node_path:
            return self.node.get_fully_qualified_name()
        if node_path.startswith("/"):
            return node_path
        return f"{self.node.get_namespace().rstrip('/')}/{node_path}"
