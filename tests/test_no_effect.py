"""An argument that is accepted without effect says so, once. Policies all have an effect."""

from __future__ import annotations

import pytest

from aionode.arguments import parse_arguments
from aionode.clock import Duration
from aionode.engine.context import Context
from aionode.interfaces.example_interfaces.srv import AddTwoInts
from aionode.interfaces.std_msgs.msg import String
from aionode.node import Node
from aionode.qos import LivelinessPolicy, QoSProfile, qos_profile_best_available
from aionode.testing import ManualClock, local_context


@pytest.fixture
def clock() -> ManualClock:
    """The time, which tests step."""
    return ManualClock()


def program(clock: ManualClock, *words: str) -> Context:
    """Return the context of a program with these ROS arguments."""
    context = local_context(clock=clock)
    context.arguments = parse_arguments(["program", "--ros-args", *words])
    return context


def warnings(caplog: pytest.LogCaptureFixture) -> list[str]:
    """Return the warnings so far."""
    return [record.getMessage() for record in caplog.records if record.levelname == "WARNING"]


# Arguments


async def test_a_rule_that_matches_nothing_is_named(
    clock: ManualClock, caplog: pytest.LogCaptureFixture
) -> None:
    """With the name that was probably meant; once, a second after the start."""
    context = program(clock, "-r", "chater:=/talk")
    async with Node("node", context=context) as node:
        node.create_publisher(String, "/chatter", 10)
        assert warnings(caplog) == []
        await clock.advance(5.0)

    (text,) = warnings(caplog)
    assert text.startswith("-r chater:=/talk: has matched no name of this program's nodes so far")
    assert text.endswith("did you mean '/chatter'?")


async def test_a_parameter_that_no_node_declares_is_named(
    clock: ManualClock, caplog: pytest.LogCaptureFixture
) -> None:
    """With the one that was probably meant."""
    context = program(clock, "-p", "sped:=0.8")
    async with Node("driver", context=context) as node:
        node.declare_parameter("speed", 0.5)
        await clock.advance(5.0)

    (text,) = warnings(caplog)
    assert text == (
        "-p sped:=0.8: no node has declared the parameter 'sped' so far, so it changes nothing; "
        "did you mean 'speed'?"
    )


async def test_a_parameter_for_a_node_that_is_not_here_is_named(
    clock: ManualClock, caplog: pytest.LogCaptureFixture
) -> None:
    """The name of the node may be wrong, too."""
    async with Node("driver", context=program(clock, "-p", "drive:speed:=0.8")) as node:
        node.declare_parameter("speed", 0.5)
        await clock.advance(5.0)

    assert warnings(caplog) == [
        "-p drive:speed:=0.8: this program has no such node, so it changes nothing"
    ]


@pytest.mark.parametrize(
    "words",
    [
        ["-r", "chatter:=/talk"],
        ["-r", "/*:=/talk"],
        ["-r", "rosservice:///add:=/sum"],
        ["-r", "__node:=other"],
        ["-r", "node:__ns:=/robot"],
        ["-p", "speed:=0.8"],
        ["-p", "use_sim_time:=true"],
        ["-p", "first:a:=1"],
    ],
)
async def test_what_is_of_use_to_any_node_is_not_mentioned(
    clock: ManualClock, caplog: pytest.LogCaptureFixture, words: list[str]
) -> None:
    """To one that is made later, or gone by then, as well."""
    # Other matters: all nodes have one name then, and nobody publishes simulated time.
    others = ("there are two nodes named", "use_sim_time is true, and nobody")
    context = program(clock, *words)
    first = Node("first", context=context)
    first.declare_parameter("a", 0)
    first.destroy_node()
    async with Node("node", context=context) as node:
        node.create_publisher(String, "/chatter", 10)
        await clock.advance(0.5)
        async with Node("late", context=context) as late:
            late.declare_parameter("speed", 0.5)
            late.create_client(AddTwoInts, "/add")
            await clock.advance(5.0)

    assert [text for text in warnings(caplog) if not text.startswith(others)] == []


async def test_a_node_that_takes_any_parameter_has_use_for_each(
    clock: ManualClock, caplog: pytest.LogCaptureFixture
) -> None:
    """It may read them at any time."""
    context = program(clock, "-p", "any:=1")
    async with Node("node", context=context, allow_undeclared_parameters=True):
        await clock.advance(5.0)

    assert warnings(caplog) == []


async def test_a_program_that_ends_soon_is_not_judged(
    clock: ManualClock, caplog: pytest.LogCaptureFixture
) -> None:
    """It may not have come to all of its names."""
    async with Node("node", context=program(clock, "-r", "a:=b")):
        await clock.advance(0.5)
    await clock.advance(5.0)

    assert warnings(caplog) == []


async def test_the_arguments_of_a_single_node_are_looked_at_too(
    clock: ManualClock, caplog: pytest.LogCaptureFixture
) -> None:
    """`cli_args` are the same grammar."""
    words = ["--ros-args", "-p", "b:=1"]
    async with Node("node", context=local_context(clock=clock), cli_args=words):
        await clock.advance(5.0)

    assert [text.partition(":=")[0] for text in warnings(caplog)] == ["-p b"]


# Policies


@pytest.mark.parametrize(
    "profile",
    [
        10,
        qos_profile_best_available,
        QoSProfile(depth=1, deadline=Duration(seconds=0.1)),
        QoSProfile(depth=1, lifespan=Duration(seconds=2)),
        QoSProfile(
            depth=1,
            liveliness=LivelinessPolicy.MANUAL_BY_TOPIC,
            liveliness_lease_duration=Duration(seconds=1),
        ),
    ],
)
def test_every_policy_is_kept_so_none_is_mentioned(
    clock: ManualClock, caplog: pytest.LogCaptureFixture, profile: QoSProfile | int
) -> None:
    """What the node creates itself, such as /rosout with its lifespan, is not mentioned either."""
    node = Node("node", context=local_context(clock=clock))
    node.create_publisher(String, "/scan", profile)
    node.create_subscription(String, "/scan", print, profile)
    node.create_service(AddTwoInts, "/add", lambda request: AddTwoInts.Response())
    node.destroy_node()

    assert warnings(caplog) == []
