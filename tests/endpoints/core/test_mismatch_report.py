"""Warnings about endpoints of one name that cannot communicate, where ROS 2 says nothing."""

from __future__ import annotations

import pytest

from aionode import Context, Node
from aionode.engine.wire.typehash import type_hash
from aionode.graph import EndpointInfo, EndpointKind, NodeInfo
from aionode.interfaces.example_interfaces.srv import AddTwoInts, SetBool
from aionode.interfaces.std_msgs.msg import Int8, String
from aionode.message import Message, type_name
from aionode.qos import qos_profile_default


def warnings(caplog: pytest.LogCaptureFixture) -> list[str]:
    """Return the warnings so far."""
    return [record.getMessage() for record in caplog.records if record.levelname == "WARNING"]


def remote(kind: EndpointKind, name: str, ros_type: type, known_hash: str = "") -> EndpointInfo:
    """Return an endpoint of another process."""
    return EndpointInfo(
        kind,
        NodeInfo("abc", 1, "robot", "/"),
        1,
        name,
        type_name(ros_type),
        known_hash or type_hash(ros_type),
        qos_profile_default,
        bytes(range(16)),
    )


async def test_two_types_of_one_topic_are_reported(
    node: Node, caplog: pytest.LogCaptureFixture
) -> None:
    """Within a process, when the second of the two appears."""
    node.create_publisher(String, "/words", 10)

    node.create_subscription(Int8, "/words")

    (text,) = warnings(caplog)
    assert text == (
        "topic '/words': the subscription of node /node has type std_msgs/msg/Int8, this "
        "publisher std_msgs/msg/String. They will not hear each other; use the same type, or "
        "another name"
    )


async def test_another_type_in_another_process_is_reported(
    node: Node, context: Context, caplog: pytest.LogCaptureFixture
) -> None:
    """Over Zenoh such messages travel under different keys, and nothing fails."""
    node.create_subscription(String, "/words")

    context.graph.add_endpoint(remote(EndpointKind.PUBLISHER, "/words", Int8))

    (text,) = warnings(caplog)
    assert "the publisher of node /robot has type std_msgs/msg/Int8" in text


async def test_another_definition_in_another_process_is_reported(
    node: Node, context: Context, caplog: pytest.LogCaptureFixture
) -> None:
    """Two versions of a package: the name is the same, and the hash is not."""
    node.create_publisher(String, "/words", 10)

    context.graph.add_endpoint(
        remote(EndpointKind.SUBSCRIPTION, "/words", String, "RIHS01_" + "0" * 64)
    )

    (text,) = warnings(caplog)
    assert "the subscription of node /robot has another definition of std_msgs/msg/String" in text
    assert text.endswith("use the same version of the interface package on both sides")


async def test_two_types_of_one_service_are_reported(
    node: Node, context: Context, caplog: pytest.LogCaptureFixture
) -> None:
    """A client would wait forever."""
    node.create_client(AddTwoInts, "/do")

    context.graph.add_endpoint(remote(EndpointKind.SERVER, "/do", SetBool))

    (text,) = warnings(caplog)
    assert text.startswith("service '/do': the server of node /robot has type")


async def test_two_classes_of_one_definition_fit(
    node: Node, caplog: pytest.LogCaptureFixture
) -> None:
    """Only the name and the hash count."""

    class Words(Message, typename="std_msgs/msg/String"):
        data: str = ""

    node.create_publisher(Words, "/words", 10)
    node.create_subscription(String, "/words")

    assert warnings(caplog) == []
