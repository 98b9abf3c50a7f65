"""Interoperation with ROS 2 Humble, whose nodes write no type hashes, by a plain Zenoh peer.

The peer knows only the wire format: keys, tokens, attachments and bytes.
"""

from __future__ import annotations

import asyncio
import json
import logging
import struct
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest
import zenoh  # noqa: TID251  # the peer, without aionode

from aionode import Context
from aionode.engine.wire import cdr
from aionode.interfaces import get_message
from aionode.interfaces.example_interfaces.action import Fibonacci
from aionode.interfaces.example_interfaces.srv import AddTwoInts
from aionode.interfaces.rcl_interfaces.srv import GetParameters
from aionode.interfaces.std_msgs.msg import String
from aionode.message import from_builtins
from tests.support.actions import Goal
from tests.support.peers import Collector, known, quiet_node, raw_session, ros_value

if TYPE_CHECKING:
    from collections.abc import AsyncIterator

DOMAIN_ID = 42
NO_HASH = "TypeHashNotSupported"
VECTORS: dict[str, Any] = json.loads(
    (Path(__file__).parents[3] / "vectors" / "vectors.json").read_text(encoding="utf-8")
)
STRING = VECTORS["messages"]["std_msgs/msg/String"]
ADD = VECTORS["services"]["example_interfaces/srv/AddTwoInts"]
FIBONACCI = VECTORS["actions"]["example_interfaces/action/Fibonacci"]
CHATTER = f"{DOMAIN_ID}/chatter/{STRING['dds_type']}/{NO_HASH}"
ADD_KEY = f"{DOMAIN_ID}/add/{ADD['dds_type']}/{NO_HASH}"


def attachment(sequence: int) -> bytes:
    """Return what goes with each sample and query: number, time, and id of the sender."""
    return struct.pack("<qqB16s", sequence, 1_700_000_000_000_000_000, 16, b"an own client id")


def token(session: zenoh.Session, kind: str, name: str, dds_type: str) -> str:
    """Return the token of an endpoint of the peer's node."""
    return (
        f"@ros2_lv/{DOMAIN_ID}/{session.zid()}/0/1/{kind}/%/%/peer/%{name}/{dds_type}/{NO_HASH}"
        "/::,10:,:,:,,"
    )


@pytest.fixture
async def context() -> AsyncIterator[Context]:
    """A context that speaks Humble."""
    async with Context(ros_distro="humble") as context:
        yield context


async def ask(session: zenoh.Session, key: str, payload: bytes) -> bytes:
    """Return the answer of a service, retrying while no route to it is known."""
    for sequence in range(1, 1000):
        replies = Collector()
        session.get(
            key,
            replies,
            payload=payload,
            attachment=attachment(sequence),
            target=zenoh.QueryTarget.ALL_COMPLETE,
            consolidation=zenoh.ConsolidationMode.NONE,
            timeout=20.0,
        )
        with suppress(TimeoutError):
            async with asyncio.timeout(0.3):
                (reply,) = await replies.have(1)
                assert reply.ok is not None
                return bytes(reply.ok.payload.to_bytes())
    raise AssertionError(key)


async def test_tokens_and_samples_are_those_of_humble(context: Context) -> None:
    """A Humble node matches and receives by these texts alone."""
    async with quiet_node("talker", context) as node:
        publisher = node.create_publisher(String, "chatter", 10)
        with raw_session() as session:
            samples = Collector()
            subscriber = session.declare_subscriber(CHATTER, samples)
            (seen,) = await known(session, f"@ros2_lv/{DOMAIN_ID}/**/%chatter/**")
            reader = session.liveliness().declare_token(
                token(session, "MS", "chatter", STRING["dds_type"])
            )
            await publisher.wait_for_subscribers()
            publisher.publish(from_builtins(String, ros_value(STRING["value"])))
            (sample,) = await samples.have(1)
            reader.undeclare()
            subscriber.undeclare()

    assert seen.split("/")[-2] == NO_HASH
    assert str(sample.key_expr) == CHATTER
    assert sample.payload.to_bytes().hex() == STRING["cdr"]


async def test_samples_of_humble_are_heard(context: Context) -> None:
    """A subscription with the type receives them, though nothing identifies its definition."""
    async with quiet_node("listener", context) as node:
        subscription = node.create_subscription(get_message("std_msgs/msg/String"), "chatter")
        with raw_session() as session:
            await known(session, f"@ros2_lv/{DOMAIN_ID}/**/MS/**")
            session.put(CHATTER, bytes.fromhex(STRING["cdr"]), attachment=attachment(1))
            msg = await subscription.receive()

    assert msg == from_builtins(String, ros_value(STRING["value"]))


async def test_a_client_of_humble_calls_a_service(context: Context) -> None:
    """The request and the response are as everywhere; only the key differs."""
    heard = []

    def add(request: AddTwoInts.Request, response: AddTwoInts.Response) -> AddTwoInts.Response:
        heard.append(request)
        return from_builtins(AddTwoInts.Response, ADD["response"]["value"])

    async with quiet_node("server", context) as node:
        node.create_service(AddTwoInts, "add", add)
        with raw_session() as session:
            answer = await ask(session, ADD_KEY, bytes.fromhex(ADD["request"]["cdr"]))

    assert answer.hex() == ADD["response"]["cdr"]
    assert heard[0] == from_builtins(AddTwoInts.Request, ADD["request"]["value"])


async def test_a_service_of_humble_is_called(context: Context) -> None:
    """It is found by its token, and asked by its key."""
    async with quiet_node("client", context) as node:
        with raw_session() as session:

            def answer(query: zenoh.Query) -> None:
                assert query.payload is not None
                assert query.payload.to_bytes().hex() == ADD["request"]["cdr"]
                payload = bytes.fromhex(ADD["response"]["cdr"])
                query.reply(ADD_KEY, payload, attachment=attachment(1))

            queryable = session.declare_queryable(ADD_KEY, answer, complete=True)
            server = session.liveliness().declare_token(
                token(session, "SS", "add", ADD["dds_type"])
            )
            client = node.create_client(AddTwoInts, "add")
            await client.wait_for_service()
            request = from_builtins(AddTwoInts.Request, ADD["request"]["value"])
            response = await client.call(request)
            server.undeclare()
            queryable.undeclare()

    assert response == from_builtins(AddTwoInts.Response, ADD["response"]["value"])


async def test_an_action_client_of_humble_sends_a_goal(context: Context) -> None:
    """All five parts of an action have their key without a hash."""

    async def execute(goal: Goal) -> Fibonacci.Result:
        goal.succeed()
        return Fibonacci.Result(sequence=[0, 1, 1, 2, 3, 5])

    def key(part: str) -> str:
        dds_type = FIBONACCI["endpoints"][part]["dds_type"]
        return f"{DOMAIN_ID}/fibonacci/_action/{part}/{dds_type}/{NO_HASH}"

    golden = {name: bytes.fromhex(entry["cdr"]) for name, entry in FIBONACCI["cdr"].items()}
    async with quiet_node("server", context) as node:
        node.create_action_server(Fibonacci, "fibonacci", execute)
        with raw_session() as session:
            unknown = bytes.fromhex("00010000") + b"\x08" * 16
            await ask(session, key("get_result"), unknown)  # now the way is known
            accepted = await ask(session, key("send_goal"), golden["SendGoal_Request"])
            result = await ask(session, key("get_result"), golden["GetResult_Request"])

    assert accepted[4] == 1
    assert result == golden["GetResult_Response"]


async def test_parameters_are_read_by_humble(context: Context) -> None:
    """Every node of Humble, and `ros2 param`, asks for them."""
    async with quiet_node("robot", context, start_parameter_services=True) as node:
        node.declare_parameter("speed", 3)
        with raw_session() as session:
            key = (
                f"{DOMAIN_ID}/robot/get_parameters/rcl_interfaces::srv::dds_::GetParameters_/"
                f"{NO_HASH}"
            )
            answer = await ask(session, key, cdr.encode(GetParameters.Request(names=["speed"])))

    assert cdr.decode(GetParameters.Response, answer).values[0].integer_value == 3


async def test_a_humble_node_has_no_service_that_humble_does_not_know(context: Context) -> None:
    """Type descriptions came after Humble."""
    async with quiet_node("robot", context) as node:
        assert not node.has_parameter("start_type_description_service")
        assert not list(node.services)


@pytest.mark.parametrize(
    ("ros_distro", "expected"),
    [
        (None, "a Humble robot is here: set ROS_DISTRO=humble to talk to it"),
        ("humble", None),
    ],
)
async def test_a_node_beside_a_humble_robot_says_what_to_set(
    ros_distro: str | None, expected: str | None, caplog: pytest.LogCaptureFixture
) -> None:
    """Otherwise both sides look healthy and receive nothing."""
    caplog.set_level(logging.WARNING)
    async with Context(ros_distro=ros_distro) as context, quiet_node("listener", context) as node:
        node.create_subscription(String, "chatter", None)
        with raw_session() as session:
            theirs = session.liveliness().declare_token(
                token(session, "MP", "chatter", STRING["dds_type"])
            )
            while not node.count_publishers("chatter"):
                await node.graph.changed()
            theirs.undeclare()
    warnings = [one.getMessage() for one in caplog.records if "Humble" in one.getMessage()]

    assert len(warnings) == (expected is not None)
    assert all(expected is not None and expected in one for one in warnings)
