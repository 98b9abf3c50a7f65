"""A node's built-in topics and services: log, parameters and types.

Each is built on the node's public methods, as a program would do it, except for handing log
messages over to the node's event loop.
"""

from __future__ import annotations

import contextlib
from typing import TYPE_CHECKING

from aionode import qos
from aionode.endpoints.core.node_core import core_of
from aionode.engine.log_levels import LevelAnswers, log_message
from aionode.errors import QueueFullError
from aionode.interfaces.rcl_interfaces.msg import Log, ParameterDescriptor, ParameterEvent
from aionode.interfaces.rcl_interfaces.srv import GetLoggerLevels, SetLoggerLevels
from aionode.interfaces.type_description_interfaces.srv import GetTypeDescription
from aionode.parameter import parameter_services

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.endpoints.core.node_methods import NodeMethods
    from aionode.logging import LogEvent
    from aionode.parameter import ParameterStore
    from aionode.qos import QoSProfile

__all__ = [
    "publish_log",
    "publish_parameter_events",
    "serve_logger_levels",
    "serve_parameters",
    "serve_type_descriptions",
]

# Log


def publish_log(node: NodeMethods, profile: QoSProfile | int) -> Callable[[], None]:
    """Publish the node's log on ``/rosout``; return a function that stops it.

    Messages may be logged in any thread; they are published in the thread of the event loop.
    """
    publisher = node.create_publisher(Log, "/rosout", profile)

    def publish(event: LogEvent) -> None:
        # Logging must not fail because the queue of a log reader is full.
        if not publisher.destroyed:
            with contextlib.suppress(QueueFullError):
                publisher.publish(log_message(event, node.get_clock().now()))

    def sink(event: LogEvent) -> None:
        core_of(node).affinity.call(lambda: publish(event))

    return node.get_logger().add_sink(sink)


def serve_logger_levels(node: NodeMethods) -> None:
    """Let other nodes get and set the log levels of this process."""
    answers = LevelAnswers()
    node.create_service(GetLoggerLevels, "~/get_logger_levels", answers.get_levels)
    node.create_service(SetLoggerLevels, "~/set_logger_levels", answers.set_levels)


# Parameters


def publish_parameter_events(node: NodeMethods) -> Callable[[ParameterEvent], None]:
    """Create a function that publishes parameter changes on ``/parameter_events``."""
    publisher = node.create_publisher(
        ParameterEvent, "/parameter_events", qos.qos_profile_parameter_events
    )

    def publish(event: ParameterEvent) -> None:
        event.stamp = node.get_clock().now().to_msg()
        if not publisher.destroyed:
            publisher.publish(event)

    return publish


def serve_parameters(node: NodeMethods, store: ParameterStore) -> None:
    """Let other nodes get and set the node's parameters."""
    for service in parameter_services(store):
        node.create_service(
            service.srv_type,
            f"~/{service.name}",
            service.callback,
            qos_profile=qos.qos_profile_parameters,
        )


# Types


def serve_type_descriptions(node: NodeMethods) -> None:
    """Let other nodes get the descriptions of the types that the node uses."""
    if node.context.ros_distro == "humble":
        return  # Humble has neither the service nor its type
    name = "start_type_description_service"
    descriptor = ParameterDescriptor(
        description="If enabled, start the ~/get_type_description service.", read_only=True
    )
    if not node.declare_parameter(name, True, descriptor).value:
        return

    def describe(
        request: GetTypeDescription.Request, response: GetTypeDescription.Response
    ) -> GetTypeDescription.Response:
        from aionode.engine.type_descriptions import describe_type, type_of  # rarely needed

        entities = (*node.publishers, *node.subscriptions, *node.services, *node.clients)
        answer: GetTypeDescription.Response = describe_type(
            map(type_of, entities), request, response
        )
        return answer

    node.create_service(GetTypeDescription, "~/get_type_description", describe)
