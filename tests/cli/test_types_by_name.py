"""Types that only other nodes define."""

from __future__ import annotations

import json
from collections.abc import Callable
from typing import Annotated, Any

import pytest

from aionode import Node
from aionode.cli._nouns.action import send_goal
from aionode.cli._nouns.interface import proto
from aionode.cli._nouns.service import call
from aionode.cli._nouns.topic.echo import echo
from aionode.cli._support.lookup import topic_type
from aionode.cli._support.session import make_node
from aionode.engine.wire.typehash import type_hash
from aionode.errors import CommandError
from aionode.interfaces.example_interfaces.action import Fibonacci
from aionode.message import (
    ActionType,
    Array,
    Message,
    ServiceType,
    float64,
    int32,
    to_builtins,
)
from aionode.testing import settle

# `by_name=False`: the command finds none of them, as if they were in another process.


class Words(Message, typename="foreign/msg/Words", by_name=False):
    """A message of the other program."""

    text: str = ""


class Reverse(ServiceType, typename="foreign/srv/Reverse", by_name=False):
    """A service of the other program."""

    class Request(Message):
        """The text to reverse."""

        text: str = ""

    class Response(Message):
        """The reversed text."""

        text: str = ""


class Walk(ActionType, typename="foreign/action/Walk", by_name=False):
    """An action of the other program."""

    class Goal(Message):
        """The way to go."""

        steps: int32 = 0

    class Result(Message):
        """The way that was gone."""

        walked: int32 = 0

    class Feedback(Message):
        """The way so far."""

        walked: int32 = 0


async def test_echo_learns_a_type_from_the_node_that_publishes_it(
    running: Any, tool: Node, node_factory: Callable[..., Node], screen: Any
) -> None:
    """ros2 needs the package on the inspecting machine."""
    publisher = node_factory("talker").create_publisher(Words, "/words", 1)
    learned = await topic_type(tool, "/words")

    assert learned is not Words
    async with running(echo(tool, "/words", fields=("text",), output=screen.output)):
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
        tool, "/reverse", "foreign/srv/Reverse", values="{text: abc}", output=screen.json_output
    )

    assert screen.records == [{"text": "cba"}]


async def test_send_goal_learns_an_action_type(
    tool: Node, node_factory: Callable[..., Node], screen: Any
) -> None:
    """The tutorial's /navigate_to has a type that exists only as a Python class."""

    async def walk(goal: Any) -> Walk.Result:
        goal.succeed()
        return Walk.Result(walked=goal.request.steps)

    node_factory("server").create_action_server(Walk, "/walk", walk)
    await settle()

    status = await send_goal(
        tool, "/walk", "foreign/action/Walk", values="{steps: 3}", output=screen.json_output
    )

    assert status == 0
    assert screen.records[-1]["result"] == {"walked": 3}


class Drive(ActionType, typename="foreign/action/Drive", by_name=False):
    """An action whose goal has defaults."""

    class Goal(Message):
        """How to drive."""

        tolerance: float64 = 0.05
        heading: float64 = -1.5
        frame: str = "map"
        gains: Annotated[Any, Array[float64, 2]] = (0.5, -0.25)

    class Result(Message):
        """Nothing."""

    class Feedback(Message):
        """Nothing."""


async def test_a_goal_of_defaults_has_those_that_the_server_describes(
    tool: Node, node_factory: Callable[..., Node], screen: Any
) -> None:
    """With a tolerance of 0.0 instead, a robot hunted its goal forever."""
    goals: list[Any] = []

    async def drive(goal: Any) -> Drive.Result:
        goals.append(goal.request)
        goal.succeed()
        return Drive.Result()

    node_factory("server").create_action_server(Drive, "/drive", drive)
    await settle()

    await send_goal(tool, "/drive", "foreign/action/Drive", values="{}", output=screen.output)
    proto(await tool.find_type("foreign/action/Drive"), output=screen.json_output)

    assert goals == [Drive.Goal()]
    assert json.loads(screen.text.splitlines()[-1]) == to_builtins(Drive.Goal())


async def test_commands_describe_the_types_that_they_use(node_factory: Any) -> None:
    """If only a command listens to a topic, no other node knows its type."""
    other = node_factory("other")
    async with make_node(other.context) as own:
        own.create_subscription(Words, "/words")
        own.create_client(Reverse, "/reverse")
        assert (await other.find_type("foreign/msg/Words"))(text="a").text == "a"
        assert (await other.find_type("foreign/srv/Reverse")).Request(text="a").text == "a"


async def test_a_type_that_no_node_describes_is_an_error_with_a_way_out(
    tool: Node, node_factory: Callable[..., Node], screen: Any
) -> None:
    """Folder and option are named."""
    silent = node_factory("silent", parameter_overrides=[silence()])
    silent.create_publisher(Words, "/words", 1)

    with pytest.raises(CommandError, match="Type of '/words': it is not known here") as raised:
        await echo(tool, "/words", output=screen.output)

    assert "/silent does not describe it" in str(raised.value)
    assert "--interfaces PATH" in str(raised.value)


async def test_another_definition_of_a_known_type_is_learnt(
    tool: Node, node_factory: Callable[..., Node]
) -> None:
    """A robot may have a newer version of a standard package."""

    class String(Message, typename="std_msgs/msg/String", by_name=False):
        data: str
        language: str

    node_factory("talker").create_publisher(String, "/text", 1)

    learned = await topic_type(tool, "/text")

    assert learned is not None
    assert type_hash(learned) == type_hash(String)


async def test_an_action_that_is_known_is_not_asked_for(tool: Node) -> None:
    """The common case costs no request."""
    assert await tool.find_type("example_interfaces/action/Fibonacci") is Fibonacci


def silence() -> Any:
    """Return the parameter that makes a node not describe its types."""
    from aionode.parameter import Parameter

    return Parameter("start_type_description_service", value=False)
