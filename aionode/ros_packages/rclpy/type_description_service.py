"""The service by which other nodes request the definition of a type that a node uses."""

from __future__ import annotations

import weakref
from typing import TYPE_CHECKING, Any

from rclpy._impl import messages as msg
from rclpy.parameter import Parameter
from rosidl_generator_py import aionode_class, from_aionode

if TYPE_CHECKING:
    from rclpy._protocols import NodeLike
    from rclpy.service import Service

__all__ = ["START_TYPE_DESCRIPTION_SERVICE_PARAM", "TypeDescriptionService"]

START_TYPE_DESCRIPTION_SERVICE_PARAM = "start_type_description_service"


class TypeDescriptionService:
    """The service of one node, unless a parameter disables it.

    Attributes:
        service_name: Its name.
        enabled: Whether it exists.
    """

    def __init__(self, node: NodeLike) -> None:
        self._node_weak_ref = weakref.ref(node)
        self._service: Service[Any, Any] | None = None
        self.service_name = f"{node.get_name()}/get_type_description"
        self.enabled = False
        if not node.has_parameter(START_TYPE_DESCRIPTION_SERVICE_PARAM):
            descriptor = msg.ParameterDescriptor(
                name=START_TYPE_DESCRIPTION_SERVICE_PARAM,
                type=int(Parameter.Type.BOOL),
                description="If enabled, start the ~/get_type_description service.",
                read_only=True,
            )
            node.declare_parameter(START_TYPE_DESCRIPTION_SERVICE_PARAM, True, descriptor)
        parameter = node.get_parameter(START_TYPE_DESCRIPTION_SERVICE_PARAM)
        if parameter.type_ == Parameter.Type.BOOL:
            self.enabled = parameter.value
        else:
            node.get_logger().error(
                f"Invalid type for parameter '{START_TYPE_DESCRIPTION_SERVICE_PARAM}' "
                f"{parameter.type_!r} should be bool"
            )
        if self.enabled:
            self._service = node.create_service(
                msg.GetTypeDescription, self.service_name, self._service_callback
            )

    def destroy(self) -> None:
        """Drop the service, which the node destroys."""
        self._service = None

    def _service_callback(self, request: Any, response: Any) -> Any:
        node = self._node_weak_ref()
        if node is None:
            raise ReferenceError("Expected valid node weak reference")
        from aionode.engine.type_descriptions import describe_type, type_of  # rarely used

        entities = (*node._publishers, *node._subscriptions, *node._services, *node._clients)
        used = [aionode_class(type_of(entity)) for entity in entities]
        for waitable in node._Node__waitables:
            action_type = getattr(waitable, "_action_type", None)  # of clients and servers
            if action_type is not None:
                impl: Any = aionode_class(action_type).Impl
                used += [impl.SendGoalService, impl.GetResultService, impl.FeedbackMessage]
        return describe_type(used, request, response, from_aionode)
