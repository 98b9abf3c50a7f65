"""The parameters of another node."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rclpy._entities import wait_until
from rclpy._impl import messages as msg
from rclpy.parameter import Parameter, parameter_dict_from_yaml_file
from rclpy.qos import (
    QoSProfile,
    qos_profile_parameter_events,
    qos_profile_services_default,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from rclpy.callback_groups import CallbackGroup
    from rclpy.client import Client
    from rclpy.event_handler import SubscriptionEventCallbacks
    from rclpy.node import Node
    from rclpy.qos_overriding_options import QoSOverridingOptions
    from rclpy.subscription import Subscription
    from rclpy.task import Future

__all__ = ["AsyncParameterClient"]

SERVICES: dict[str, Any] = {
    "get_parameters": msg.GetParameters,
    "list_parameters": msg.ListParameters,
    "set_parameters": msg.SetParameters,
    "get_parameter_types": msg.GetParameterTypes,
    "describe_parameters": msg.DescribeParameters,
    "set_parameters_atomically": msg.SetParametersAtomically,
}
"""The services of a node's parameters, by their names below the node's name."""


class AsyncParameterClient:
    """Reads and sets the parameters of another node; each call returns a future for the response.

    An executor with `node` has to spin meanwhile. A `callback` is called with the future when it is
    done.

    Args:
        node: The node that sends the requests.
        remote_node_name: The other node.
        qos_profile: QoS of the services.
        callback_group: The group of their clients.
    """

    def __init__(
        self,
        node: Node,
        remote_node_name: str,
        qos_profile: QoSProfile = qos_profile_services_default,
        callback_group: CallbackGroup | None = None,
    ) -> None:
        self.remote_node_name = remote_node_name
        self.node = node
        self._clients: dict[str, Client[Any, Any]] = {
            name: node.create_client(
                srv_type,
                f"{remote_node_name}/{name}",
                qos_profile=qos_profile,
                callback_group=callback_group,
            )
            for name, srv_type in SERVICES.items()
        }

    def services_are_ready(self) -> bool:
        """Return whether all services are available."""
        return all(client.service_is_ready() for client in self._clients.values())

    def wait_for_services(self, timeout_sec: float | None = None) -> bool:
        """Block the thread until all services are available; return whether they were in time."""
        return wait_until(self.services_are_ready, self.node.context, timeout_sec)

    def list_parameters(
        self,
        prefixes: list[str] | None = None,
        depth: int | None = None,
        callback: Callable[[Future[Any]], None] | None = None,
    ) -> Future[Any]:
        """Request names."""
        return self._ask("list_parameters", callback, prefixes=prefixes or [], depth=depth or 0)

    def get_parameters(
        self, names: list[str], callback: Callable[[Future[Any]], None] | None = None
    ) -> Future[Any]:
        """Request values."""
        return self._ask("get_parameters", callback, names=names)

    def set_parameters(
        self,
        parameters: Sequence[Any],
        callback: Callable[[Future[Any]], None] | None = None,
    ) -> Future[Any]:
        """Set parameters, given as `Parameter` or as messages, one by one."""
        return self._ask("set_parameters", callback, parameters=as_messages(parameters))

    def describe_parameters(
        self, names: list[str], callback: Callable[[Future[Any]], None] | None = None
    ) -> Future[Any]:
        """Request descriptors."""
        return self._ask("describe_parameters", callback, names=names)

    def get_parameter_types(
        self, names: list[str], callback: Callable[[Future[Any]], None] | None = None
    ) -> Future[Any]:
        """Request types."""
        return self._ask("get_parameter_types", callback, names=names)

    def set_parameters_atomically(
        self,
        parameters: Sequence[Any],
        callback: Callable[[Future[Any]], None] | None = None,
    ) -> Future[Any]:
        """Set parameters, given as `Parameter` or as messages, all or none."""
        messages = as_messages(parameters)
        return self._ask("set_parameters_atomically", callback, parameters=messages)

    def delete_parameters(
        self, names: list[str], callback: Callable[[Future[Any]], None] | None = None
    ) -> Future[Any]:
        """Undeclare parameters, where that is allowed."""
        return self.set_parameters([Parameter(name) for name in names], callback)

    def load_parameter_file(
        self,
        parameter_file: str,
        use_wildcard: bool = False,
        callback: Callable[[Future[Any]], None] | None = None,
    ) -> Future[Any]:
        """Set the parameters in a file for the other node, one by one."""
        return self.set_parameters(self._in_file(parameter_file, use_wildcard), callback)

    def load_parameter_file_atomically(
        self,
        parameter_file: str,
        use_wildcard: bool = False,
        callback: Callable[[Future[Any]], None] | None = None,
    ) -> Future[Any]:
        """Set the parameters in a file for the other node, all or none."""
        return self.set_parameters_atomically(self._in_file(parameter_file, use_wildcard), callback)

    def _ask(
        self, service: str, callback: Callable[[Future[Any]], None] | None, **fields: Any
    ) -> Future[Any]:
        """Send a request, and call `callback` with its future."""
        future = self._clients[service].call_async(SERVICES[service].Request(**fields))
        if callback is not None:
            future.add_done_callback(callback)
        return future

    def _in_file(self, parameter_file: str, use_wildcard: bool) -> list[Any]:
        parameters = parameter_dict_from_yaml_file(
            parameter_file, use_wildcard, target_nodes=[self.remote_node_name]
        )
        return list(parameters.values())

    def on_parameter_event(
        self,
        callback: Callable[..., Any],
        qos_profile: QoSProfile = qos_profile_parameter_events,
        *,
        callback_group: CallbackGroup | None = None,
        event_callbacks: SubscriptionEventCallbacks | None = None,
        qos_overriding_options: QoSOverridingOptions | None = None,
        raw: bool = False,
    ) -> Subscription[Any]:
        """Return a subscription to the parameter events of all nodes."""
        return self.node.create_subscription(
            msg.ParameterEvent,
            "/parameter_events",
            callback,
            qos_profile,
            callback_group=callback_group,
            event_callbacks=event_callbacks,
            qos_overriding_options=qos_overriding_options,
            raw=raw,
        )


def as_messages(parameters: Sequence[Any]) -> list[Any]:
    """Return parameters as messages."""
    return [
        parameter.to_parameter_msg() if isinstance(parameter, Parameter) else parameter
        for parameter in parameters
    ]
