"""``aionode topic``: list, info, type and find."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from aionode import Node
from aionode.cli._nouns.topic import info, list_topics
from aionode.cli._support.nouns import TOPIC
from aionode.errors import CommandError, InvalidTopicNameException
from aionode.interfaces.std_msgs.msg import Int8, String


@pytest.fixture
async def talker(node_factory: Callable[..., Node]) -> Node:
    """A node that publishes /chatter, and another one that listens."""
    node = node_factory("talker")
    node.create_publisher(String, "/chatter", 10)
    node_factory("listener").create_subscription(String, "/chatter", qos_profile=10)
    return node


async def test_list_prints_what_ros2_prints(tool: Node, talker: Node, screen: Any) -> None:
    """A newcomer compares this output with the tutorial's, line by line."""
    await list_topics(tool, output=screen.output)

    assert screen.text == "/chatter\n/parameter_events\n/rosout\n"


async def test_list_with_types_prints_them_in_brackets(
    tool: Node, talker: Node, screen: Any
) -> None:
    """Scripts cut this line at the bracket."""
    await list_topics(tool, types=True, output=screen.output)

    assert screen.text == (
        "/chatter [std_msgs/msg/String]\n"
        "/parameter_events [rcl_interfaces/msg/ParameterEvent]\n"
        "/rosout [rcl_interfaces/msg/Log]\n"
    )


async def test_verbose_list_prints_who_publishes_and_who_subscribes(
    tool: Node, talker: Node, screen: Any
) -> None:
    """The two blocks, their plural and their empty lines are ros2's."""
    await list_topics(tool, verbose=True, output=screen.output)

    assert screen.text == (
        "Published topics:\n"
        " * /chatter [std_msgs/msg/String] 1 publisher\n"
        " * /parameter_events [rcl_interfaces/msg/ParameterEvent] 2 publishers\n"
        " * /rosout [rcl_interfaces/msg/Log] 2 publishers\n"
        "\n"
        "Subscribed topics:\n"
        " * /chatter [std_msgs/msg/String] 1 subscriber\n"
        "\n"
    )


async def test_the_command_does_not_list_itself(tool: Node, screen: Any) -> None:
    """ros2 counts its own endpoints; the user wants to know what was there before."""
    tool.create_subscription(String, "/mine", qos_profile=1)

    await list_topics(tool, output=screen.output)

    assert screen.text == ""


async def test_count_prints_a_number(tool: Node, talker: Node, screen: Any) -> None:
    """``-c`` is for scripts."""
    await list_topics(tool, count=True, output=screen.output)

    assert screen.text == "3\n"


async def test_hidden_topics_are_listed_on_request(
    tool: Node, node_factory: Callable[..., Node], screen: Any
) -> None:
    """The topics of an action are an implementation detail, shown only on request."""
    node_factory("server", enable_rosout=False).create_publisher(Int8, "/a/_action/status", 1)

    await list_topics(tool, output=screen.output)
    before = screen.text
    await list_topics(tool, hidden=True, output=screen.output)

    assert "_action" not in before
    assert "/a/_action/status" in screen.text


async def test_json_list_has_one_record_for_each_topic(
    tool: Node, talker: Node, screen: Any
) -> None:
    """A program reads lines; each has everything that the text options show."""
    await list_topics(tool, output=screen.json_output)

    assert screen.records[0] == {
        "name": "/chatter",
        "types": ["std_msgs/msg/String"],
        "publishers": 1,
        "subscriptions": 1,
    }


async def test_info_prints_type_and_counts(tool: Node, talker: Node, screen: Any) -> None:
    """The tutorial's second command."""
    await info(tool, "/chatter", output=screen.output)

    assert screen.text == "Type: std_msgs/msg/String\nPublisher count: 1\nSubscription count: 1\n"


async def test_verbose_info_prints_every_endpoint(tool: Node, talker: Node, screen: Any) -> None:
    """Everything needed to find out why two endpoints do not match."""
    (publisher,) = talker.get_publishers_info_by_topic("/chatter")
    (subscription,) = talker.get_subscriptions_info_by_topic("/chatter")

    await info(tool, "/chatter", verbose=True, output=screen.output)

    def block(name: str, kind: str, gid: list[int]) -> str:
        return (
            f"Node name: {name}\n"
            "Node namespace: /\n"
            "Topic type: std_msgs/msg/String\n"
            "Topic type hash: "
            "RIHS01_df668c740482bbd48fb39d76a70dfd4bd59db1288021743503259e948f6b1a18\n"
            f"Endpoint type: {kind}\n"
            f"GID: {'.'.join(f'{byte:02x}' for byte in gid)}\n"
            "QoS profile:\n"
            "  Reliability: RELIABLE\n"
            "  History (Depth): KEEP_LAST (10)\n"
            "  Durability: VOLATILE\n"
            "  Lifespan: Infinite\n"
            "  Deadline: Infinite\n"
            "  Liveliness: AUTOMATIC\n"
            "  Liveliness lease duration: Infinite\n\n"
        )

    assert screen.text == (
        "Type: std_msgs/msg/String\n\n"
        "Publisher count: 1\n\n"
        + block("talker", "PUBLISHER", publisher.endpoint_gid)
        + "Subscription count: 1\n\n"
        + block("listener", "SUBSCRIPTION", subscription.endpoint_gid)
    )


async def test_json_info_tells_the_qos(tool: Node, talker: Node, screen: Any) -> None:
    """A program compares profiles without parsing text."""
    await info(tool, "/chatter", verbose=True, output=screen.json_output)

    (record,) = screen.records
    assert record["publishers"][0]["node"] == "/talker"
    assert record["publishers"][0]["qos"]["reliability"] == "reliable"


async def test_a_relative_name_belongs_to_the_root(tool: Node, talker: Node, screen: Any) -> None:
    """ros2 requires the slash; without it the name is unambiguous too."""
    await info(tool, "chatter", output=screen.output)

    assert screen.text.startswith("Type: std_msgs/msg/String")


async def test_a_topic_of_two_types_shows_both(
    tool: Node, talker: Node, node_factory: Callable[..., Node], screen: Any
) -> None:
    """Two types under one name are a mistake that has to be visible."""
    node_factory("other").create_publisher(Int8, "/chatter", 1)

    await info(tool, "/chatter", output=screen.output)

    assert screen.text.startswith("Type: ['std_msgs/msg/Int8', 'std_msgs/msg/String']\n")


async def test_type_prints_the_type(tool: Node, talker: Node, screen: Any) -> None:
    """Its output can be piped into ``interface show -``."""
    await TOPIC.print_type(tool, "/chatter", output=screen.output)

    assert screen.text == "std_msgs/msg/String\n"


async def test_find_prints_the_topics_of_a_type(tool: Node, talker: Node, screen: Any) -> None:
    """The other direction of ``type``."""
    await TOPIC.find(tool, "std_msgs/msg/String", output=screen.output)
    await TOPIC.find(tool, "std_msgs/msg/Int8", output=screen.output)

    assert screen.text == "/chatter\n"


@pytest.mark.parametrize("verb", [info, TOPIC.print_type])
async def test_an_unknown_topic_is_named_with_one_like_it(
    verb: Callable[..., Any], tool: Node, talker: Node, screen: Any
) -> None:
    """ros2's ``topic type`` says nothing at all and returns 1."""
    with pytest.raises(
        CommandError, match=r"^Unknown topic '/chater'\. Did you mean '/chatter'\?$"
    ):
        await verb(tool, "/chater", output=screen.output)


async def test_an_impossible_name_is_no_unknown_one(tool: Node, screen: Any) -> None:
    """Waiting for an invalid name would never end."""
    with pytest.raises(InvalidTopicNameException, match="must not contain characters"):
        await info(tool, "/no blanks", output=screen.output)
