"""The services through which other nodes read and set the parameters of a node."""

from __future__ import annotations

import weakref
from typing import TYPE_CHECKING, Any

from aionode.rclpy._impl import messages as msg
from aionode.rclpy.exceptions import (
    ParameterNotDeclaredException,
    ParameterUninitializedException,
)
from aionode.rclpy.parameter import Parameter
from aionode.rclpy.qos import qos_profile_parameters

if TYPE_CHECKING:
    from aionode.rclpy._protocols import NodeLike

__all__ = ["ParameterService"]


class ParameterService:
    """The six services of one node.

    If one of several names is unknown, reading answers with an empty list: there is no other way
    in these services to say so.
    """

    def __init__(self, node: NodeLike) -> None:
        self._node_weak_ref = weakref.ref(node)
        name = node.get_name()
        for service, srv_type, callback in (
            ("describe_parameters", msg.DescribeParameters, self._describe_parameters_callback),
            ("get_parameters", msg.GetParameters, self._get_parameters_callback),
            ("get_parameter_types", msg.GetParameterTypes, self._get_parameter_types_callback),
            ("list_parameters", msg.ListParameters, self._list_parameters_callback),
            ("set_parameters", msg.SetParameters, self._set_parameters_callback),
            (
                "set_parameters_atomically",
                msg.SetParametersAtomically,
                self._set_parameters_atomically_callback,
            ),
        ):
            node.create_service(
                srv_type, f"{name}/{service}", callback, qos_profile=qos_profile_parameters
            )

    def _describe_parameters_callback(self, request: Any, response: Any) -> Any:
        try:
            response.descriptors = self._get_node().describe_parameters(list(request.names))
        except ParameterNotDeclaredException:
            response.descriptors = []
        return response

    def _get_parameters_callback(self, request: Any, response: Any) -> Any:
        try:
            found = self._get_node().get_parameters(list(request.names))
        except (ParameterNotDeclaredException, ParameterUninitializedException):
            found = []
        response.values = [parameter.get_parameter_value() for parameter in found]
        return response

    def _get_parameter_types_callback(self, request: Any, response: Any) -> Any:
        try:
            response.types = bytes(self._get_node().get_parameter_types(list(request.names)))
        except ParameterNotDeclaredException:
            response.types = b""
        return response

    def _list_parameters_callback(self, request: Any, response: Any) -> Any:
        response.result = self._get_node().list_parameters(list(request.prefixes), request.depth)
        return response

    def _set_parameters_callback(self, request: Any, response: Any) -> Any:
        response.results = [self._set([each]) for each in request.parameters]
        return response

    def _set_parameters_atomically_callback(self, request: Any, response: Any) -> Any:
        response.result = self._set(request.parameters)
        return response

    def _set(self, messages: list[Any]) -> Any:
        node = self._get_node()
        try:
            parameters = [Parameter.from_parameter_msg(message) for message in messages]
            return node.set_parameters_atomically(parameters)
        except (ParameterNotDeclaredException, ValueError) as error:
            return msg.SetParametersResult(successful=False, reason=str(error))

    def _get_node(self) -> NodeLike:
        node = self._node_weak_ref()
        if node is None:
            raise ReferenceError("Expected valid node weak reference")
        return node
