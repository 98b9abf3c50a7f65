"""Types without a local definition."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from aionode import Node
from aionode.cli._support.lookup import topic_type
from aionode.cli._support.type_discovery import type_from
from aionode.cli._verbs.service import call
from aionode.cli._verbs.topic_echo import echo
from aionode.errors import CommandError
from aionode.interfaces import get_interface
from aionode.interfaces.example_interfaces.srv import AddTwoInts
from aionode.interfaces.std_msgs.msg import Header
from aionode.message import (
    DEFAULT,
    Array,
    Bounded,
    Message,
    Sequence,
    ServiceType,
    byte,
    float64,
    int32,
    wstring,
)
from aionode.testing import settle
from aionode.wire._type_description import description_message
from aionode.wire.typehash import type_hash


class Words(Message, typename="tutorial/msg/Words"):
    """A type of the user's own."""

    header: Header = DEFAULT
    text: str = ""
    bounded: Bounded[str, 7] = ""
    wide: wstring = ""
    one: byte = b"\x00"
    scores: Sequence[float64] = DEFAULT
    few: Sequence[int32, 3] = DEFAULT
    nine: Array[float64, 9] = DEFAULT
    names: Sequence[Bounded[str, 5], 2] = DEFAULT
    stamps: Sequence[Header] = DEFAULT


class Reverse(ServiceType, typename="tutorial/srv/Reverse"):
    """A service of the user's own."""

    class Request(Message):
        """What to reverse."""

        text: str = ""

    class Response(Message):
        """The reversed text."""

        text: str = ""


@pytest.mark.parametrize(
    "cls",
    [
        Words,
        Reverse,
        AddTwoInts,
        *map(get_interface, ("std_msgs/msg/Empty", "sensor_msgs/msg/PointCloud2")),
        *map(get_interface, ("rcl_interfaces/msg/ParameterEvent", "std_srvs/srv/Empty")),
    ],
)
def test_a_class_made_of_a_description_has_the_same_hash(cls: Any) -> None:
    """The type hash decides whether two endpoints communicate."""
    made = type_from(description_message(cls))

    assert type_hash(made) == type_hash(cls)


async def test_echo_learns_a_type_from_the_node_that_publishes_it(
    running: Any, tool: Node, node_factory: Callable[..., Node], screen: Any
) -> None:
    """ros2 needs the package on the inspecting machine."""
    publisher = node_factory("talker").create_publisher(Words, "/words", 1)
    found = await topic_type(tool, "/words")

    assert found is not Words
    async with running(echo(tool, "/words", field="text", output=screen.output)):
        publisher.publish(Words(text="hello"))
        await settle()
    assert screen.text == "hello\n---\n"


async def test_call_learns_a_service_type(
    tool: Node, node_factory: Callable[..., Node], screen: Any
) -> None:
    """The tutorial's exercise with a custom type, from the second terminal."""

    def reverse(request: Reverse.Request, response: Reverse.Response) -> Reverse.Response:
        response.text = request.text[::-1]
        return response

    node_factory("server").create_service(Reverse, "/reverse", reverse)

    await call(
        tool, "/reverse", "tutorial/srv/Reverse", values="{text: abc}", output=screen.json_output
    )

    assert screen.records == [{"text": "cba"}]


async def test_a_type_that_no_node_describes_is_an_error_with_a_way_out(
    tool: Node, node_factory: Callable[..., Node], screen: Any
) -> None:
    """Folder and option are named."""
    silent = node_factory("silent", parameter_overrides=[silence()])
    silent.create_publisher(Words, "/words", 1)

    with pytest.raises(CommandError, match="'tutorial/msg/Words' is not known here") as raised:
        await echo(tool, "/words", output=screen.output)

    assert "/silent does not describe it" in str(raised.value)
    assert "--interfaces PATH" in str(raised.value)


async def test_another_definition_of_a_known_type_is_learnt(
    tool: Node, node_factory: Callable[..., Node]
) -> None:
    """A robot may have a newer version of a standard package."""

    class String(Message, typename="std_msgs/msg/String"):
        data: str
        language: str

    node_factory("talker").create_publisher(String, "/text", 1)

    found = await topic_type(tool, "/text")

    assert found is not None
    assert type_hash(found) == type_hash(String)


def silence() -> Any:
    """Return the parameter with which a node does not describe its types."""
    from aionode.parameter import Parameter

    return Parameter("start_type_description_service", value=False)
