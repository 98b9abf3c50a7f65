"""Tests of `Node.find_type`, and of finding the program's types by name."""

from __future__ import annotations

import gc
from collections.abc import Callable
from typing import Any

import pytest

from aionode import Node
from aionode.engine.wire.typehash import type_hash
from aionode.errors import InterfaceNotFoundError
from aionode.graph import EndpointKind
from aionode.interfaces import (
    get_action,
    get_interface,
    get_message,
    get_service,
    interface_names,
)
from aionode.interfaces.example_interfaces.action import Fibonacci
from aionode.interfaces.example_interfaces.srv import AddTwoInts
from aionode.interfaces.std_msgs.msg import String
from aionode.interfaces.type_description_interfaces.srv import GetTypeDescription
from aionode.message import ActionType, Message, ServiceType, float64


class Foreign(Message, typename="foreign/msg/Foreign", by_name=False):
    """A class that cannot be found by name, as if another process had it."""

    text: str = ""


def test_a_class_of_the_program_is_found_by_its_name() -> None:
    """A program that gets a name from a file or a request needs no import of its own."""

    class Words(Message, typename="own_msgs/msg/Words"):
        text: str = ""

    class Say(ServiceType, typename="own_msgs/srv/Say"):
        class Request(Message):
            pass

        class Response(Message):
            pass

    class Walk(ActionType, typename="own_msgs/action/Walk"):
        class Goal(Message):
            pass

        class Result(Message):
            pass

        class Feedback(Message):
            pass

    assert get_message("own_msgs/msg/Words") is Words
    assert get_message("own_msgs/Words") is Words
    assert get_service("own_msgs/srv/Say") is Say
    assert get_action("own_msgs/action/Walk") is Walk
    assert interface_names("own_msgs") == (
        "own_msgs/msg/Words",
        "own_msgs/srv/Say",
        "own_msgs/action/Walk",
    )


def test_a_class_that_the_program_has_dropped_is_not_kept_for_its_name() -> None:
    """The memory of a program that keeps creating classes does not grow."""

    class Words(Message, typename="dropped_msgs/msg/Words"):
        text: str = ""

    del Words
    gc.collect()

    with pytest.raises(InterfaceNotFoundError):
        get_message("dropped_msgs/msg/Words")


async def test_a_known_type_is_found_without_a_node_that_uses_it(
    node_factory: Callable[..., Node],
) -> None:
    """A program may look for its types before it knows any peer."""
    assert await node_factory("asker").find_type("std_msgs/msg/String") is String


async def test_a_type_is_learnt_from_the_node_that_uses_it(
    node_factory: Callable[..., Node],
) -> None:
    """A bag, a bridge or a browser subscribes to whatever exists."""
    node_factory("talker").create_publisher(Foreign, "/foreign", 1)

    found = await node_factory("asker").find_type("foreign/msg/Foreign")

    assert found is not Foreign
    assert type_hash(found) == type_hash(Foreign)


@pytest.mark.parametrize(
    ("name", "found"),
    [
        ("action/Fibonacci_FeedbackMessage", Fibonacci.Impl.FeedbackMessage),
        ("action/Fibonacci_Goal", Fibonacci.Goal),
        ("action/Fibonacci_SendGoal", Fibonacci.Impl.SendGoalService),
        ("action/Fibonacci_SendGoal_Request", Fibonacci.Impl.SendGoalService.Request),
        ("action/Fibonacci_GetResult_Event", Fibonacci.Impl.GetResultService.Event),
        ("srv/AddTwoInts_Response", AddTwoInts.Response),
        ("srv/AddTwoInts_Event", AddTwoInts.Event),
    ],
)
def test_the_parts_of_services_and_actions_have_names(name: str, found: Any) -> None:
    """The graph shows them; of an action it shows nothing else."""
    assert get_interface(f"example_interfaces/{name}") is found


@pytest.mark.parametrize(
    "name", ["srv/AddTwoInts_Goal", "srv/None_Event", "msg/String_Event", "_Goal"]
)
def test_a_part_that_there_is_not_has_no_name(name: str) -> None:
    """A service has no goal, and a message has no parts."""
    with pytest.raises(InterfaceNotFoundError):
        get_interface(f"example_interfaces/{name}")


class Walk(ActionType, typename="foreign/action/Walk", by_name=False):
    """An action that cannot be found by name, as if another process had it."""

    class Goal(Message):
        """How far."""

        metres: float64 = 0.5

    class Result(Message):
        """Nothing."""

    class Feedback(Message):
        """How far it has come."""

        metres: float64 = 0.0


@pytest.mark.parametrize(
    ("part", "described"),
    [
        ("FeedbackMessage", Walk.Impl.FeedbackMessage),
        ("Goal", Walk.Goal),
        ("SendGoal_Request", Walk.Impl.SendGoalService.Request),
    ],
)
async def test_the_parts_of_an_action_are_learnt_from_the_node_that_has_it(
    node_factory: Callable[..., Node], part: str, described: Any
) -> None:
    """A bag records its feedback, and a page shows it."""
    node_factory("walker").create_action_server(Walk, "walk", lambda goal: Walk.Result())

    found = await node_factory("asker").find_type(f"foreign/action/Walk_{part}")

    assert type_hash(found) == type_hash(described)


async def test_a_type_that_nobody_has_is_an_error(node_factory: Callable[..., Node]) -> None:
    """It does not wait: the type may never appear."""
    with pytest.raises(InterfaceNotFoundError, match="no such interface"):
        await node_factory("asker").find_type("nobody_msgs/msg/Nothing")


async def lying_node(node_factory: Callable[..., Node], describe: Callable[..., Any]) -> None:
    """Run a node that uses `Foreign`, and answers requests for its description arbitrarily."""
    from aionode.parameter import Parameter

    liar = node_factory(
        "liar", parameter_overrides=[Parameter("start_type_description_service", value=False)]
    )
    liar.create_publisher(Foreign, "/foreign", 1)
    liar.create_service(GetTypeDescription, "~/get_type_description", describe)


async def test_a_description_with_another_hash_is_not_believed(
    node_factory: Callable[..., Node],
) -> None:
    """Messages are decoded as the type whose hash the graph shows, or not at all."""

    def describe(_: Any, response: Any) -> Any:
        from aionode.engine.wire.typehash import description_message

        response.successful = True
        response.type_description = description_message(String)
        response.type_description.type_description.type_name = "foreign/msg/Foreign"
        return response

    await lying_node(node_factory, describe)

    with pytest.raises(InterfaceNotFoundError, match="/liar describes a type with the hash RIHS01"):
        await node_factory("asker").find_type("foreign/msg/Foreign")


async def test_a_description_beyond_the_limits_is_named(
    node_factory: Callable[..., Node],
) -> None:
    """Thirty levels of two fields would be a billion values."""
    from tests.engine.wire.test_described_type import tower

    def describe(_: Any, response: Any) -> Any:
        response.successful = True
        response.type_description = tower(30, width=2)
        return response

    await lying_node(node_factory, describe)

    with pytest.raises(InterfaceNotFoundError, match="at most 64 MiB are allowed"):
        await node_factory("asker").find_type("foreign/msg/Foreign")


async def test_only_some_nodes_are_asked(node_factory: Callable[..., Node]) -> None:
    """Nodes that do not answer must not add up to an endless wait."""
    asked = 0

    def refuse(_: Any, response: Any) -> Any:
        nonlocal asked
        asked += 1
        return response

    from aionode.parameter import Parameter

    for number in range(9):
        mute = node_factory(
            f"mute{number}",
            parameter_overrides=[Parameter("start_type_description_service", value=False)],
        )
        mute.create_publisher(Foreign, "/foreign", 1)
        mute.create_service(GetTypeDescription, "~/get_type_description", refuse)

    asker = node_factory("asker")
    with pytest.raises(InterfaceNotFoundError, match="and 4 more does not describe it"):
        await asker.find_type("foreign/msg/Foreign")

    assert asked == 5
    assert not asker.graph.count(EndpointKind.CLIENT, "/mute0/get_type_description")


async def test_a_type_is_found_by_its_kind_and_another_kind_is_refused(
    node_factory: Callable[..., Node],
) -> None:
    """So type checkers know what code for any service gets."""
    node = node_factory("asking")

    assert await node.find_message("std_msgs/msg/String") is String
    assert await node.find_service("example_interfaces/srv/AddTwoInts") is AddTwoInts
    assert await node.find_action("example_interfaces/action/Fibonacci") is Fibonacci
    with pytest.raises(
        InterfaceNotFoundError, match=r"std_msgs/msg/String: it is not of kind service; "
    ):
        await node.find_service("std_msgs/msg/String")
