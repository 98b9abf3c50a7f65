"""A node of rclpy that looks at the nodes beside it, uses all they offer, and prints what it saw.

`compare.py` runs it beside a program: with ROS 2's rclpy beside a program on ROS 2, with aionode's
beside the same program on aionode. It prints one JSON object: the graph, the parameters, the
answers of services and action servers, the messages that came, and the lines in the log.
The first argument is a JSON object of values to send: by topic, service or action.
"""

from __future__ import annotations

import contextlib
import json
import re
import sys
import time
from importlib import import_module
from typing import Any

from rcl_interfaces.msg import Log
from rcl_interfaces.srv import DescribeParameters, GetParameters, ListParameters, SetParameters

import rclpy
from rclpy.action import ActionClient
from rclpy.action.graph import (
    get_action_client_names_and_types_by_node,
    get_action_server_names_and_types_by_node,
)
from rclpy.node import Node
from rclpy.parameter import Parameter
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy

SELF = "program_observer"
SETTLED_SEC = 1.5
APPEARS_SEC = 20.0
ANSWER_SEC = 5.0
TIMES = 4
PERIOD_SEC = 0.2
NOT_SHOWN = re.compile(
    r"/(get_type_description|(describe|get|list|set)_parameters|get_parameter_types"
    r"|set_parameters_atomically|(get|set)_logger_levels)$|/_action/"
)
OF_EVERY_NODE = {"/rosout", "/parameter_events"}
GRAPH = {
    "publishers": Node.get_publisher_names_and_types_by_node,
    "subscriptions": Node.get_subscriber_names_and_types_by_node,
    "services": Node.get_service_names_and_types_by_node,
    "clients": Node.get_client_names_and_types_by_node,
    "action servers": get_action_server_names_and_types_by_node,
    "action clients": get_action_client_names_and_types_by_node,
}


def interface(name: str) -> Any:
    """Return the class of a type such as ``std_msgs/msg/String``."""
    package, kind, short = name.split("/")
    return getattr(import_module(f"{package}.{kind}"), short)


def plain(value: Any) -> Any:
    """Return a message as JSON has it; what tells the time becomes zero."""
    if hasattr(value, "get_fields_and_field_types"):
        if {"sec", "nanosec"} == set(value.get_fields_and_field_types()):
            return "a time"
        return {name: plain(getattr(value, name)) for name in value.get_fields_and_field_types()}
    if isinstance(value, str | bool | int):
        return value
    if isinstance(value, bytes):
        return list(value)
    if isinstance(value, float):
        return round(value, 6)
    return [plain(each) for each in (value.tolist() if hasattr(value, "tolist") else value)]


def fill(message: Any, values: dict[str, Any]) -> Any:
    """Set the fields of a message that values name, within each other."""
    for name, value in values.items():
        old = getattr(message, name)
        if isinstance(value, dict):
            fill(old, value)
        elif value and isinstance(value, list) and isinstance(value[0], dict):
            kind = re.sub(r"\[.*", "", message.get_fields_and_field_types()[name])
            kind = re.sub(r"^sequence<(.*?)(, \d+)?>$", r"\1", kind)
            package, short = kind.split("/")
            cls = interface(f"{package}/msg/{short}")
            setattr(message, name, [fill(cls(), each) for each in value])
        else:
            setattr(message, name, value)
    return message


class Observer:
    """The view of one node on the others."""

    def __init__(self, values: dict[str, Any]) -> None:
        self.values = values
        self.node = rclpy.create_node(SELF, start_parameter_services=False, enable_rosout=False)
        self.heard: dict[str, list[Any]] = {}
        self.lines: set[str] = set()
        self.node.create_subscription(
            Log,
            "/rosout",
            lambda log: self.lines.add(f"{log.level} {log.name}: {without_numbers(log.msg)}"),
            QoSProfile(depth=1000, durability=DurabilityPolicy.TRANSIENT_LOCAL),
        )

    def spin(self, seconds: float) -> None:
        """Spin for some time."""
        until = time.monotonic() + seconds
        while (left := until - time.monotonic()) > 0:
            rclpy.spin_once(self.node, timeout_sec=left)

    def wait(self, future: Any) -> Any:
        """Return the result of a future, or a word if there is none in time."""
        rclpy.spin_until_future_complete(self.node, future, timeout_sec=ANSWER_SEC)
        return future.result() if future.done() else None

    def others(self) -> list[tuple[str, str]]:
        """Return the names and namespaces of the other nodes."""
        every = self.node.get_node_names_and_namespaces()
        return sorted(each for each in every if each[0] != SELF and "_ros2cli" not in each[0])

    def graph(self) -> dict[str, Any]:
        """Return what each node has, without what all nodes have."""
        found: dict[str, Any] = {}
        for name, namespace in self.others():
            full = f"{namespace.rstrip('/')}/{name}"
            found[full] = mine = {}
            for what, ask in GRAPH.items():
                with contextlib.suppress(Exception):
                    mine[what] = {
                        topic: types
                        for topic, types in sorted(ask(self.node, name, namespace))
                        if not NOT_SHOWN.search(topic) and topic not in OF_EVERY_NODE
                    }
        return found

    def wait_for_others(self) -> dict[str, Any]:
        """Return the graph when it has not changed for a while."""
        until = time.monotonic() + APPEARS_SEC
        graph, since = self.graph(), time.monotonic()
        while time.monotonic() < until:
            self.spin(0.3)
            if (now := self.graph()) != graph or not now:
                graph, since = now, time.monotonic()
            elif time.monotonic() - since > SETTLED_SEC:
                break
        return graph

    def endpoints(self, graph: dict[str, Any]) -> dict[str, Any]:
        """Return the QoS of each publisher and subscription, as far as every middleware tells."""
        found: dict[str, Any] = {}
        for kind, ask in (
            ("publishers", self.node.get_publishers_info_by_topic),
            ("subscriptions", self.node.get_subscriptions_info_by_topic),
        ):
            for topic in {topic for mine in graph.values() for topic in mine.get(kind, {})}:
                found[f"{kind} {topic}"] = sorted(
                    f"{info.node_name} {info.topic_type} {info.qos_profile.reliability.name}"
                    f" {info.qos_profile.durability.name} {info.qos_profile.liveliness.name}"
                    f" {info.qos_profile.deadline.nanoseconds}"
                    f" {info.qos_profile.lifespan.nanoseconds}"
                    for info in ask(topic)
                    if info.node_name != SELF
                )
        return found

    def listen(self, graph: dict[str, Any]) -> None:
        """Subscribe to every topic that another node publishes."""
        for mine in graph.values():
            for topic, types in mine.get("publishers", {}).items():
                if topic in self.heard:
                    continue
                self.heard[topic] = []
                infos = self.node.get_publishers_info_by_topic(topic)
                kept = all(
                    i.qos_profile.durability is DurabilityPolicy.TRANSIENT_LOCAL for i in infos
                )
                sure = all(i.qos_profile.reliability is ReliabilityPolicy.RELIABLE for i in infos)
                qos = QoSProfile(
                    depth=100,
                    durability=DurabilityPolicy(1 if kept else 2),
                    reliability=ReliabilityPolicy(1 if sure else 2),
                )
                self.node.create_subscription(
                    interface(types[0]),
                    topic,
                    lambda msg, into=self.heard[topic]: into.append(plain(msg)),
                    qos,
                )

    def feed(self, graph: dict[str, Any]) -> None:
        """Publish to every topic that another node subscribes to."""
        topics = {
            topic: types[0]
            for mine in graph.values()
            for topic, types in mine.get("subscriptions", {}).items()
        }
        publishers = []
        for topic, kind in sorted(topics.items()):
            infos = self.node.get_subscriptions_info_by_topic(topic)
            kept = any(i.qos_profile.durability is DurabilityPolicy.TRANSIENT_LOCAL for i in infos)
            qos = QoSProfile(depth=10, durability=DurabilityPolicy(1 if kept else 2))
            publishers.append(
                (topic, kind, self.node.create_publisher(interface(kind), topic, qos))
            )
        self.spin(0.5)
        for _ in range(TIMES):
            for topic, kind, publisher in publishers:
                message = fill(interface(kind)(), self.values.get(topic, {}))
                if hasattr(message, "header"):
                    message.header.stamp = self.node.get_clock().now().to_msg()
                publisher.publish(message)
                self.spin(PERIOD_SEC / len(publishers))
        self.spin(0.5)

    def call(self, service: str, cls: Any, request: Any) -> Any:
        """Return the response of a service, or None."""
        client = self.node.create_client(cls, service)
        try:
            if not client.wait_for_service(ANSWER_SEC):
                return None
            return self.wait(client.call_async(request))
        finally:
            self.node.destroy_client(client)

    def services(self, graph: dict[str, Any]) -> dict[str, Any]:
        """Return the answer of each service."""
        found: dict[str, Any] = {}
        for mine in graph.values():
            for name, types in mine.get("services", {}).items():
                cls = interface(types[0])
                answer = self.call(name, cls, fill(cls.Request(), self.values.get(name, {})))
                found[name] = None if answer is None else plain(answer)
        return found

    def actions(self, graph: dict[str, Any]) -> dict[str, Any]:
        """Return what becomes of a goal of each action."""
        found: dict[str, Any] = {}
        for mine in graph.values():
            for name, types in mine.get("action servers", {}).items():
                cls = interface(types[0])
                client = ActionClient(self.node, cls, name)
                if not client.wait_for_server(ANSWER_SEC):
                    found[name] = "no server"
                    continue
                goal = fill(cls.Goal(), self.values.get(name, {}))
                handle = self.wait(client.send_goal_async(goal))
                if handle is None or not handle.accepted:
                    found[name] = "no answer" if handle is None else "rejected"
                    continue
                result = self.wait(handle.get_result_async())
                if result is None:
                    cancel = self.wait(handle.cancel_goal_async())
                    result = self.wait(handle.get_result_async())
                    found[f"{name} canceled"] = None if cancel is None else cancel.return_code
                found[name] = result and [result.status, plain(result.result)]
        return found

    def parameters(self, graph: dict[str, Any]) -> dict[str, Any]:
        """Return the parameters of each node, and what setting one to its own value says."""
        found: dict[str, Any] = {}
        for node in graph:
            listed = self.call(f"{node}/list_parameters", ListParameters, ListParameters.Request())
            if listed is None:
                found[node] = None
                continue
            names = sorted(listed.result.names)
            values = self.call(
                f"{node}/get_parameters", GetParameters, GetParameters.Request(names=names)
            )
            described = self.call(
                f"{node}/describe_parameters",
                DescribeParameters,
                DescribeParameters.Request(names=names),
            )
            pairs = zip(names, values.values if values else (), strict=False)
            request = SetParameters.Request(
                parameters=[
                    Parameter(
                        name, value=rclpy.parameter.parameter_value_to_python(value)
                    ).to_parameter_msg()
                    for name, value in pairs
                    if value.type
                ]
            )
            answer = self.call(f"{node}/set_parameters", SetParameters, request)
            found[node] = {
                "names": names,
                "prefixes": sorted(listed.result.prefixes),
                "values": values and plain(values)["values"],
                "descriptors": described and plain(described)["descriptors"],
                "set": answer and plain(answer)["results"],
            }
        return found


def without_numbers(text: str) -> str:
    """Return a line without what differs from one run to the next."""
    return re.sub(r"0x[0-9a-f]+|[-+]?\d[\d.]*(e[-+]?\d+)?", "#", text)


def main() -> None:
    """Look, use, print."""
    values = json.loads(sys.argv[1]) if len(sys.argv) > 1 else {}
    rclpy.init()
    observer = Observer(values)
    graph = observer.wait_for_others()
    seen: dict[str, Any] = {"graph": graph, "endpoints": observer.endpoints(graph)}
    observer.listen(graph)
    for name in values.get("skip", []):
        for mine in graph.values():
            for offered in mine.values():
                offered.pop(name, None)
    seen["parameters"] = observer.parameters(graph)
    observer.feed(graph)
    seen["answers"] = observer.services(graph)
    seen["goals"] = observer.actions(graph)
    observer.spin(values.get("wait_sec", 0.5))
    seen["graph afterwards"] = observer.graph()
    seen["heard"] = {
        topic: sorted({json.dumps(each, sort_keys=True) for each in messages})
        for topic, messages in observer.heard.items()
    }
    seen["log"] = sorted(observer.lines)
    print(json.dumps(seen, indent=1))
    observer.node.destroy_node()
    rclpy.shutdown()


main()
