"""The gateway keeps a bounded number of things for its clients, and the policy decides first.

This also holds if a client requests several things at once, while each of them waits.
"""

from __future__ import annotations

import asyncio
import json
from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import AsyncExitStack
from typing import Any

import pytest

from aionode._process.concurrency import checkpoint
from aionode.errors import AionodeError, InterfaceNotFoundError, MessageError, RefusedError
from aionode.gateway import Policy, Session
from aionode.gateway.foxglove import client as _foxglove_client
from aionode.gateway.foxglove.client import Client
from aionode.gateway.rosbridge import rosapi as _rosapi
from aionode.gateway.rosbridge.client import MAX_MALFORMED, serve_frames
from aionode.gateway.rosbridge.request import FragmentStore
from aionode.gateway.session import feed as _feed
from aionode.gateway.session.delivery.outbox import Outbox
from aionode.gateway.session.graph import MAX_QUESTIONS
from aionode.gateway.session.lanes import Lanes
from aionode.gateway.session.robot import Robot
from aionode.gateway.session.sharing import MAX_UNUSED, Shared
from aionode.interfaces.example_interfaces.srv import AddTwoInts
from aionode.interfaces.std_msgs.msg import String
from aionode.node import Node
from aionode.qos import DurabilityPolicy, QoSProfile
from aionode.testing import settle
from tests.support.gateway_bench import Bench
from tests.support.rosbridge import RosbridgeClient

ADD = "example_interfaces/srv/AddTwoInts"
FIBONACCI = "example_interfaces/action/Fibonacci"

Do = Callable[[Session, int], Awaitable[Any]]


async def nothing(_: Any) -> dict[str, Any]:
    """Answer a request, or execute a goal."""
    return {}


async def subscribe(session: Session, number: int) -> None:
    """Subscribe to a topic of this number."""
    await session.subscribe(f"/t{number}", "std_msgs/String", frame=lambda _: None, key=number)


async def advertise(session: Session, number: int) -> None:
    """Make a publisher of this number."""
    await session.advertise(f"/t{number}", "std_msgs/String")


async def serve(session: Session, number: int) -> None:
    """Offer a service of this number."""
    await session.serve(f"/s{number}", ADD, nothing)


async def serve_action(session: Session, number: int) -> None:
    """Offer an action of this number."""
    await session.serve_action(f"/a{number}", FIBONACCI, nothing)


async def call(session: Session, number: int) -> None:
    """Call a service that exists."""
    await session.call("/add", {"a": number}, type_name=ADD)


LIMITS: dict[Do, str] = {
    subscribe: "subscriptions",
    advertise: "advertised",
    serve: "advertised",
    serve_action: "advertised",
    call: "calls",
}


@pytest.mark.parametrize("do", LIMITS)
async def test_several_at_once_do_not_pass_a_limit(
    do: Do, bench: Bench, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each waits for its type, and would otherwise find the last place free."""
    bench.node.create_service(AddTwoInts, "/add", lambda _: AddTwoInts.Response())
    verbs = ("subscribe", "publish", "call", "advertise")
    allowed = "\n".join(f"{verb} = '/**'" for verb in verbs)
    bench.allow(f"[limits]\n{LIMITS[do]} = 2\n[[allow]]\n{allowed}")
    find, known = bench.robot.find_type, asyncio.Event()

    async def find_late(*arguments: Any) -> Any:
        await known.wait()
        return await find(*arguments)

    monkeypatch.setattr(bench.robot, "find_type", find_late)
    async with bench.session() as session, asyncio.TaskGroup() as tasks:
        asked = [tasks.create_task(outcome(do(session, number))) for number in range(5)]
        await settle()
        known.set()
        await settle()
        assert [task.result() for task in asked] == ["done"] * 2 + ["too_many"] * 3
        if do is call:  # a released place is free again
            assert await outcome(do(session, 9)) == "done"


async def outcome(work: Awaitable[Any]) -> str:
    """Return the code of a refusal, or that it was done."""
    try:
        await work
    except RefusedError as error:
        return error.code
    return "done"


async def test_a_place_is_free_again_after_a_failure(bench: Bench) -> None:
    """A client that misspells a type loses nothing."""
    bench.allow("[limits]\nsubscriptions = 1\nadvertised = 1\n[[allow]]\n"
                "subscribe = '/**'\npublish = '/**'\nadvertise = '/**'")  # fmt: skip
    async with bench.session() as session:
        for work in (
            session.subscribe("/x", "std_msgs/Strin", frame=lambda _: None, key=1),
            session.advertise("/x", "std_msgs/Strin"),
            session.serve("/x", "std_srvs/Trigge", nothing),
        ):
            with pytest.raises(AionodeError, match="no such interface"):
                await work
        for do in (subscribe, advertise, serve):
            await do(session, 1)


@pytest.mark.parametrize("do", [*LIMITS, lambda session, _: send_goal(session)])
async def test_a_type_is_looked_up_after_the_policy_has_decided(
    do: Do, bench: Bench, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Looking for a type imports modules, and asks other nodes."""
    bench.robot.policy = Policy()
    refuse_to_find_types(bench.robot, monkeypatch)
    async with bench.session() as session:
        assert await outcome(do(session, 1)) == "not_allowed"


async def send_goal(session: Session) -> None:
    """Send a goal."""
    async with session.goal("/a", {}, type_name=FIBONACCI):
        pass


def refuse_to_find_types(robot: Robot, monkeypatch: pytest.MonkeyPatch) -> None:
    """Make the test fail if a type is looked up."""

    async def find(*_: Any) -> Any:
        raise AssertionError

    monkeypatch.setattr(robot, "find_type", find)


@pytest.mark.parametrize(
    "op",
    [
        {"op": "advertise_service", "service": "/s", "type": ADD},
        {"op": "advertise_action", "action": "/a", "type": FIBONACCI},
        {"op": "advertise", "topic": "/t", "type": "std_msgs/String"},
        {"op": "publish", "topic": "/t", "type": "std_msgs/String"},
    ],
)
async def test_an_op_that_is_refused_looks_for_no_type(
    op: dict[str, Any], client: RosbridgeClient, robot: Robot, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The same over rosbridge, which also queries the graph for the type of a topic."""
    robot.policy = Policy()
    refuse_to_find_types(robot, monkeypatch)
    monkeypatch.setattr(client.session.graph, "topics", None)
    client.send(**op)
    assert "the policy does not allow tester" in (await client.receive())["msg"]


async def test_unused_endpoints_are_bounded(bench: Bench) -> None:
    """A client uses one name after another: each of its publishers stays for a while."""
    shared = Shared(bench.robot.time_base)
    made = []
    for number in range(3 * MAX_UNUSED):
        entity, give_back = shared.take(number, Entity)
        made.append(entity)
        give_back()
    kept = [number for number, entity in enumerate(made) if not entity.destroyed]
    shared.close()

    assert kept == list(range(2 * MAX_UNUSED, 3 * MAX_UNUSED))
    assert all(entity.destroyed for entity in made)


class Entity:
    """A stand-in for a publisher."""

    destroyed = False

    def destroy(self) -> None:
        """End."""
        self.destroyed = True


def fragment(data: str, num: int = 0, total: int = 1, message_id: str = "m") -> dict[str, Any]:
    """Return an op with a fragment of another op."""
    return {"op": "fragment", "id": message_id, "data": data, "num": num, "total": total}


async def test_fragments_make_no_larger_frame_than_the_policy_allows(
    client: RosbridgeClient,
) -> None:
    """The limit of this client's frames is 1000 bytes, in fragments as well."""
    client.send_frame(json.dumps(fragment(" " * 600, 0, 2)))
    client.send_frame(json.dumps(fragment(" " * 600, 1, 2)))
    assert "exceed 1000 bytes" in (await client.receive())["msg"]


def test_fragments_count_in_bytes_until_they_are_complete() -> None:
    """Characters have up to four bytes; fragments of complete messages no longer count."""
    store = FragmentStore(1000)
    with pytest.raises(MessageError, match="exceed 1000 bytes"):
        store.add(fragment("\N{ROCKET}" * 300, 0, 2))
    store.add(fragment("never complete", 0, 2, "other"))
    for _ in range(10):
        store.add(fragment("a" * 400, 0, 2))
        store.add(fragment("a" * 400, 0, 2))  # the same once more
        assert store.add(fragment("b", 1, 2)) == "a" * 400 + "b"


async def test_garbage_in_fragments_is_garbage(bench: Bench) -> None:
    """A client that sends only invalid ops is disconnected, however they are split."""
    frames = iter(json.dumps(fragment("garbage")) for _ in range(MAX_MALFORMED + 50))

    async def sent() -> AsyncIterator[str]:
        for frame in frames:
            yield frame

    async with bench.session() as session:
        await serve_frames(session, sent())
    assert session.rights.refused == MAX_MALFORMED + 1
    assert len(list(frames)) == 49


async def test_channels_of_foxglove_do_not_pass_their_limit_at_once(
    bench: Bench, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each of them waits in its own lane; an id in use is not a new channel."""
    monkeypatch.setattr(_foxglove_client, "MAX_CHANNELS", 2)
    find = bench.robot.find_type

    async def find_late(*arguments: Any) -> Any:
        await checkpoint()
        return await find(*arguments)

    monkeypatch.setattr(bench.robot, "find_type", find_late)
    channels = [
        {"id": number, "topic": f"/t{number}", "encoding": "json", "schemaName": "std_msgs/String"}
        for number in (1, 1, 2, 3, 4)
    ]
    async with bench.session() as session:
        async with asyncio.TaskGroup() as tasks:
            client = Client(session, Lanes(tasks), None)
            await client.take(json.dumps({"op": "advertise", "channels": channels}))
        count = bench.node.count_publishers
        assert [name for name in ("/t1", "/t2", "/t3", "/t4") if count(name)] == ["/t1", "/t2"]


@pytest.mark.parametrize("value", [2**70, [1, "a"], {"a": 1}, [[1]]])
async def test_a_value_that_no_parameter_has_is_an_answer(bench: Bench, value: Any) -> None:
    """JSON contains numbers of any size: the client gets an error, and no traceback is logged."""
    bench.node.declare_parameter("speed", 1)
    async with bench.session() as session:
        with pytest.raises(MessageError, match="speed"):
            await session.parameters.set_json("/robot", "speed", value)


@pytest.mark.parametrize("value", ["[" * 100_000, "1" * 100, "{}"])
async def test_a_value_in_json_that_no_parameter_has_is_an_answer(
    robot: Robot, client: RosbridgeClient, value: str
) -> None:
    """Rosapi receives the value as JSON text, which may be a bomb."""
    robot.policy = Policy.default(allow_write=True)  # frames may be larger
    client.session.check_again()
    answer = await client.call("/rosapi/set_param", name="/robot_node:speed", value=value)
    assert answer["values"]["successful"] is False


# Graph queries


async def test_a_burst_of_questions_leaves_the_loop_to_others(
    bench: Bench, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Each query walks through the graph: one at a time, with the clients taking turns."""
    turns, asked = 0, []

    async def count_turns() -> None:
        nonlocal turns
        while True:
            turns += 1
            await checkpoint()

    async def answer(session: Session, _: dict[str, Any]) -> dict[str, Any]:
        asked.append((turns, session.identity.name))
        return {}

    monkeypatch.setitem(_rosapi.SERVICES, "topics", ((), answer))
    async with (
        bench.session("one") as one,
        bench.session("two") as two,
        asyncio.TaskGroup() as tasks,
    ):
        counting = tasks.create_task(count_turns())
        async with asyncio.TaskGroup() as asking:
            for session in (one, two):
                for _ in range(MAX_QUESTIONS):
                    asking.create_task(_rosapi.answer(session, "topics", {}))
            await checkpoint()
            with pytest.raises(RefusedError, match="questions") as refused:
                await _rosapi.answer(one, "topics", {})
        counting.cancel()
    assert refused.value.code == "too_many"
    assert len(asked) == 2 * MAX_QUESTIONS
    assert len({turn for turn, _ in asked}) == len(asked)
    assert {name for _, name in asked[:10]} == {"one", "two"}


@pytest.mark.parametrize(
    "name",
    [
        "a" * 300 + "/msg/X",
        "std_msgs/msg/String\n",
        "std_msgs/msg/../String",
        "std_msgs/msg/",
        "/msg/String",
        "stд_msgs/msg/String",
        "std_msgs/srv/String",
        "msg",
        "",
    ],
)
async def test_a_text_that_is_no_name_of_a_type_is_sought_nowhere(
    bench: Bench, name: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Searching names similar to a megabyte of text, which a client may send, takes a second."""
    monkeypatch.setattr(bench.robot.node, "find_type", None)
    async with bench.session() as session:
        with pytest.raises(InterfaceNotFoundError):
            await session.message_class(name)


async def test_parameters_of_many_nodes_are_listed(bench: Bench) -> None:
    """They may be more than there may be simultaneous calls."""
    bench.allow("[limits]\ncalls = 8\n[[allow]]\nsee = '/**'")
    names = [f"robot_{number}" for number in range(12)]
    async with AsyncExitStack() as stack:
        for name in names:
            await stack.enter_async_context(Node(name, context=bench.context))
        session = await stack.enter_async_context(bench.session())
        found = await _rosapi.answer(session, "get_param_names", {})
    assert {f"/{name}:use_sim_time" for name in names} <= set(found["names"])


# What is kept


def test_topics_that_a_client_has_left_are_forgotten() -> None:
    """A client may subscribe with ever new ids: no counts of them are kept."""
    outbox = Outbox()
    for number in range(10):
        for _ in range(3):
            outbox.put(number, b"frame", depth=1)
        outbox.discard(number)
    assert not outbox.dropped


async def test_messages_that_are_kept_for_late_clients_are_bounded_in_bytes(
    bench: Bench, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A camera may ask to keep a hundred pictures; the last one is always kept."""
    monkeypatch.setattr(_feed, "MAX_LATCHED_BYTES", 1000)
    latched = QoSProfile(depth=50, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    publisher = bench.node.create_publisher(String, "/words", latched)
    async with bench.session() as early, bench.session() as late:
        await early.subscribe("/words", frame=lambda each: each.message.data, key="w", depth=50)
        for size, fit in ((300, 1), (300, 2), (300, 3), (300, 3), (2000, 1)):
            publisher.publish(String(data="x" * size))
            await settle()
            key = f"after {size}, {fit}"
            newest = await late.subscribe("/words", frame=lambda each: each.message.data, key=key)
            kept = [late.outbox.next_frame() for _ in range(fit)]
            assert kept == ["x" * 300] * (fit - 1) + ["x" * size]
            assert late.outbox.next_frame() is None
            newest.close()


async def test_no_client_publishes_to_the_audit_log(bench: Bench) -> None:
    """Even though it may publish to everything else."""
    async with bench.session() as session:
        with pytest.raises(RefusedError, match="only the gateway writes it"):
            await session.publish("/gateway/audit", {"data": "{}"}, "std_msgs/String")
