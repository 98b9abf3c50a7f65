"""QoS profiles, names, and groups of endpoints for the modules of py_trees_ros."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any, Final

from py_trees_ros_interfaces.msg import PublisherDetails, ServiceDetails, SubscriberDetails
from py_trees_ros_interfaces.srv import (
    IntrospectPublishers,
    IntrospectServices,
    IntrospectSubscribers,
)

from aionode.clock import S_TO_NS, MachineTime
from py_trees_ros import exceptions
from rclpy.clock import Clock
from rclpy.clock_type import ClockType
from rclpy.duration import Duration
from rclpy.expand_topic_name import expand_topic_name
from rclpy.qos import (
    DurabilityPolicy,
    HistoryPolicy,
    QoSProfile,
    ReliabilityPolicy,
    qos_profile_services_default,
)

__all__ = [
    "Publishers",
    "Services",
    "Subscribers",
    "basename",
    "client_of",
    "create_anonymous_node_name",
    "find_service",
    "find_topics",
    "get_py_trees_home",
    "node_among",
    "qos_profile_latched",
    "qos_profile_unlatched",
    "resolve_name",
    "wait_until",
]

PERIOD_SEC: Final = 0.1
SERVER_SEC: Final = 3.0


def node_among(arguments: dict[str, Any], behaviour: Any) -> Any:
    """Return the node from the arguments of a behaviour's `setup`.

    Raises:
        KeyError: There is no node among them.
    """
    if "node" not in arguments:
        raise KeyError(
            f"didn't find 'node' in setup's kwargs [{behaviour.name}][{type(behaviour).__name__}]"
        )
    return arguments["node"]


def wait_until(condition: Callable[[], bool], timeout_sec: float | None) -> bool:
    """Block until a condition holds, checked ten times a second; return whether it does.

    Args:
        condition: The condition, which is checked at least once.
        timeout_sec: Maximum time in seconds; None to check once.
    """
    clock = Clock(clock_type=ClockType.STEADY_TIME)
    begun = MachineTime.steady_ns()
    while not condition():
        if timeout_sec is None or MachineTime.steady_ns() - begun > timeout_sec * S_TO_NS:
            return False
        clock.sleep_for(Duration(seconds=PERIOD_SEC))
    return True


def of_type(found: Iterable[Any], wanted: str, namespace: str | None) -> list[str]:
    """Return the names with a given type that contain a text."""
    return [
        name
        for name, types in found
        if wanted in types and (namespace is None or namespace in name)
    ]


def find_service(
    node: Any, service_type: str, namespace: str | None = None, timeout: float = 0.5
) -> str:
    """Return the full name of the only service of a type, waiting until it exists.

    Args:
        node: The node that searches.
        service_type: The type, such as ``std_srvs/srv/Empty``.
        namespace: A text that the name must contain.
        timeout: How long to search, in seconds.

    Raises:
        NotFoundError: There is none.
        MultipleFoundError: There are several.
    """
    names: list[str] = []

    def is_there() -> bool:
        names[:] = of_type(node.get_service_names_and_types(), service_type, namespace)
        return bool(names)

    if not wait_until(is_there, timeout):
        raise exceptions.NotFoundError(f"service not found [type: {service_type}]")
    if len(names) > 1:
        raise exceptions.MultipleFoundError(f"multiple services found [type: {service_type}]")
    return names[0]


def find_topics(
    node: Any, topic_type: str, namespace: str | None = None, timeout: float | None = 0.5
) -> list[str]:
    """Return the full names of the topics of a type, waiting until one exists.

    Args:
        node: The node that searches.
        topic_type: The type, such as ``std_msgs/msg/Empty``.
        namespace: A text that the names must contain.
        timeout: How long to search, in seconds; None to search once.
    """
    names: list[str] = []

    def is_there() -> bool:
        names[:] = of_type(node.get_topic_names_and_types(), topic_type, namespace)
        return bool(names)

    wait_until(is_there, timeout)
    return names


def basename(name: str) -> str:
    """Return the part of a name after its last slash or tilde."""
    return name.rsplit("/", 1)[-1].rsplit("~", 1)[-1]


def get_py_trees_home() -> str:
    """Return the folder for logs and similar files, which may not exist."""
    return str(Path.home() / ".ros2" / "py_trees")


def client_of(node: Any, cls: Any, name: str | None) -> Any:
    """Return a client of a service that `find_service` has found.

    Raises:
        NotReadyError: `find_service` was not called for it.
        TimedOutError: Its server does not become available in time.
    """
    if name is None:
        raise exceptions.NotReadyError(f"no known '{cls}' service known [did you call setup()?]")
    client = node.create_client(cls, name, qos_profile=qos_profile_services_default)
    if not client.wait_for_service(timeout_sec=SERVER_SEC):
        raise exceptions.TimedOutError(f"timed out waiting for {name}")
    return client


def profile(durability: DurabilityPolicy) -> QoSProfile:
    """Return a reliable profile with a depth of one message."""
    return QoSProfile(
        history=HistoryPolicy.KEEP_LAST,
        depth=1,
        durability=durability,
        reliability=ReliabilityPolicy.RELIABLE,
    )


def qos_profile_latched() -> QoSProfile:
    """Return the profile for topics whose last message late subscriptions receive."""
    return profile(DurabilityPolicy.TRANSIENT_LOCAL)


def qos_profile_unlatched() -> QoSProfile:
    """Return the profile for other topics."""
    return profile(DurabilityPolicy.VOLATILE)


def resolve_name(node: Any, name: str) -> str:
    """Return the full name of a topic or service of a node, before remapping."""
    return str(expand_topic_name(name, node.get_name(), node.get_namespace()))


def create_anonymous_node_name(node_name: str = "node") -> str:
    """Return a node name that ends in the time, so that no two are the same."""
    return f"{node_name}_{MachineTime.steady_ns()}"


def type_name(cls: Any) -> str:
    """Return the package and the name of a type, such as ``std_msgs/Empty``."""
    return f"{cls.__module__.partition('.')[0]}/{cls.__name__}"


class Publishers:
    """Several publishers as attributes, and a service that lists them.

    Args:
        node: Their node.
        publisher_details: The attribute, topic and type of each, and whether it is latched.
        introspection_topic_name: The name of the service, under ``~/introspection/``.
    """

    def __init__(
        self,
        node: Any,
        publisher_details: Iterable[tuple[str, str, Any, bool]],
        introspection_topic_name: str = "publishers",
    ) -> None:
        self.publisher_details_msg = []
        for name, topic, cls, latched in publisher_details:
            qos = qos_profile_latched() if latched else qos_profile_unlatched()
            setattr(self, name, node.create_publisher(cls, topic, qos))
            self.publisher_details_msg.append(
                PublisherDetails(
                    topic_name=resolve_name(node, topic),
                    message_type=type_name(cls),
                    latched=latched,
                )
            )
        self.introspection_service = node.create_service(
            IntrospectPublishers,
            "~/introspection/" + introspection_topic_name,
            self.introspection_callback,
        )

    def introspection_callback(self, unused_request: Any, response: Any) -> Any:
        """Answer with the list."""
        response.publisher_details = self.publisher_details_msg
        return response


class Subscribers:
    """Several subscriptions as attributes, and a service that lists them.

    Args:
        node: Their node.
        subscriber_details: The attribute, topic and type of each, whether it is latched, and
            its callback.
        introspection_topic_name: The name of the service, under ``~/introspection/``.
    """

    def __init__(
        self,
        node: Any,
        subscriber_details: Iterable[tuple[str, str, Any, bool, Callable[[Any], None]]],
        introspection_topic_name: str = "subscribers",
    ) -> None:
        self.subscriber_details_msg = []
        for name, topic, cls, latched, callback in subscriber_details:
            qos = qos_profile_latched() if latched else qos_profile_unlatched()
            setattr(self, name, node.create_subscription(cls, topic, callback, qos))
            self.subscriber_details_msg.append(
                SubscriberDetails(
                    topic_name=resolve_name(node, topic),
                    message_type=type_name(cls),
                    latched=latched,
                )
            )
        self.introspection_service = node.create_service(
            IntrospectSubscribers,
            "~/introspection/" + introspection_topic_name,
            self.introspection_callback,
        )

    def introspection_callback(self, unused_request: Any, response: Any) -> Any:
        """Answer with the list."""
        response.subscriber_details = self.subscriber_details_msg
        return response


class Services:
    """Several services as attributes, and one more that lists them.

    Args:
        node: Their node.
        service_details: The attribute, name and type of each, and its callback.
        introspection_topic_name: The name of the service, under ``~/introspection/``.
    """

    def __init__(
        self,
        node: Any,
        service_details: Iterable[tuple[str, str, Any, Callable[[Any, Any], Any]]],
        introspection_topic_name: str = "services",
    ) -> None:
        self.service_details_msg = []
        for name, service, cls, callback in service_details:
            made = node.create_service(
                cls, service, callback, qos_profile=qos_profile_services_default
            )
            setattr(self, name, made)
            self.service_details_msg.append(
                ServiceDetails(
                    service_name=resolve_name(node, service), service_type=type_name(cls)
                )
            )
        self.introspection_service = node.create_service(
            IntrospectServices,
            "~/introspection/" + introspection_topic_name,
            self.introspection_callback,
        )

    def introspection_callback(self, unused_request: Any, response: Any) -> Any:
        """Answer with the list."""
        response.service_details = self.service_details_msg
        return response
