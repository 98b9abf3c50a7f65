"""The services by which other nodes read and set the parameters of a node."""

from __future__ import annotations

import weakref
from typing import TYPE_CHECKING, Any

from aionode.errors import RequestRefusedError
from aionode.parameter import parameter_services
from rclpy._impl import messages as msg
from rclpy.exceptions import ParameterNotDeclaredException
from rclpy.parameter import Parameter
from rclpy.qos import qos_profile_parameters

if TYPE_CHECKING:
    from collections.abc import Callable

    from rclpy._protocols import NodeLike

__all__ = ["ParameterService"]


class ParameterService:
    """The six services of one node, without keeping the node alive."""

    def __init__(self, node: NodeLike) -> None:
        name = node.get_name()
        logger = node.get_logger()
        for service in parameter_services(
            weakref.proxy(node),
            Parameter,
            services=msg,
            result_class=msg.SetParametersResult,
            refusals=(ParameterNotDeclaredException, ValueError),
        ):
            node.create_service(
                service.srv_type,
                f"{name}/{service.name}",
                unless_refused(service.callback, logger, service.name),
                qos_profile=qos_profile_parameters,
            )


def unless_refused(
    callback: Callable[[Any, Any], Any], logger: Any, service_name: str
) -> Callable[[Any, Any], Any]:
    """Return `callback`, with refused requests logged and answered by an empty response."""

    def answer(request: Any, response: Any) -> Any:
        try:
            return callback(request, response)
        except RequestRefusedError as error:  # otherwise the program's spin() would raise it
            logger.warning(f"{service_name}: {error}")
            return response

    return answer
