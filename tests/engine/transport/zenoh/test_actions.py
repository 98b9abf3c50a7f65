"""Actions with an independent peer: a plain Zenoh session with bytes, keys and tokens of its own.

What it sends and expects are the bytes of ``tests/vectors/vectors.json``, which were not made by
aionode; what has no vector there is laid out here by hand.
"""

from __future__ import annotations

import asyncio
import json
import struct
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest
import zenoh  # noqa: TID251  # the peer, without aionode

from aionode.action import CancelResponse, GoalStatus
from aionode.engine.context import Context
from aionode.engine.wire import cdr
from aionode.errors import GoalLostError
from aionode.interfaces.example_interfaces.action import Fibonacci
from tests.support.actions import Goal, Worker, uuid_of
from tests.support.peers import Collector, quiet_node, raw_session

if TYPE_CHECKING:
    from collections.abc import AsyncIterator

    from aionode.node import Node

VECTORS = json.loads(
    (Path(__file__).parents[3] / "vectors" / "vectors.json").read_text(encoding="utf-8")
)["actions"]["example_interfaces/action/Fibonacci"]
CDR = {name: bytes.fromhex(entry["cdr"]) for name, entry in VECTORS["cdr"].items()}
ENDPOINTS = VECTORS["endpoints"]
DOMAIN_ID = 42
HEADER = bytes.fromhex("00010000")
GOAL_ID = bytes(range(16))
"""The goal of all vectors: order 5."""


def key(part: str) -> str:
    """Return the key of one of the five parts of /fibonacci."""
    one = ENDPOINTS[part]
    return f"{DOMAIN_ID}/fibonacci/_action/{part}/{one['dds_type']}/{one['rihs01']}"


def attachment(sequence: int) -> bytes:
    """Return what goes with every message: sequence number, time, and id of the sender."""
    return struct.pack("<qqB16s", sequence, 1_700_000_000_000_000_000, 16, b"an own client id")


def cancel_request(goal_id: bytes) -> bytes:
    """Return CancelGoal_Request: the id, and a time of 0."""
    return HEADER + goal_id + struct.pack("<iI", 0, 0)


def statuses(data: bytes) -> list[int]:
    """Return the states in a GoalStatusArray: each goal is 16 + 8 bytes, and one of state."""
    (count,) = struct.unpack_from("<I", data, 4)
    return [data[8 + 28 * number + 24] for number in range(count)]


class PlainPeer:
    """Calls services and receives topics with raw keys and bytes."""

    def __init__(self, session: zenoh.Session) -> None:
        self._session = session
        self._loop = asyncio.get_running_loop()
        self._sequence = 0

    async def ask(self, part: str, payload: bytes) -> bytes:
        """Return the first answer of a service, or the bytes of its error."""
        answer: asyncio.Future[bytes] = self._loop.create_future()

        def take(reply: zenoh.Reply) -> None:
            sample = reply.ok or reply.err
            assert sample is not None
            self._loop.call_soon_threadsafe(finish, sample.payload.to_bytes())

        def finish(data: bytes) -> None:
            if not answer.done():
                answer.set_result(data)

        self._sequence += 1
        self._session.get(
            key(part),
            take,
            payload=payload,
            attachment=attachment(self._sequence),
            target=zenoh.QueryTarget.ALL_COMPLETE,
            consolidation=zenoh.ConsolidationMode.NONE,
            timeout=20.0,
        )
        return await answer

    def hear(self, part: str) -> Collector:
        """Collect the samples of a topic."""
        heard = Collector()
        self._session.declare_subscriber(key(part), lambda s: heard(s.payload.to_bytes()))
        return heard


@pytest.fixture
async def node() -> AsyncIterator[Node]:
    """A node that the peer can reach."""
    async with asyncio.timeout(30), Context() as context, quiet_node("robot", context) as node:
        yield node


# The peer drives the server


async def test_a_plain_client_drives_a_server(node: Node) -> None:
    """Goal, feedback, status and result are those of ROS 2, byte for byte."""
    may_end = asyncio.Event()

    async def execute(goal: Goal) -> Fibonacci.Result:
        assert bytes(goal.goal_id.uuid) == GOAL_ID
        assert goal.request.order == 5
        goal.publish_feedback(Fibonacci.Feedback(sequence=[0, 1, 1]))
        await may_end.wait()
        goal.succeed()
        return Fibonacci.Result(sequence=[0, 1, 1, 2, 3, 5])

    node.create_action_server(Fibonacci, "fibonacci", execute)
    with raw_session() as session:
        peer = PlainPeer(session)
        feedback, status = peer.hear("feedback"), peer.hear("status")
        await until_asked(node, feedback)
        await until_heard(peer)

        accepted = await peer.ask("send_goal", CDR["SendGoal_Request"])
        assert accepted[:5] == HEADER + b"\x01"
        assert len(accepted) == len(CDR["SendGoal_Response"])
        assert await feedback.have(1) == [CDR["FeedbackMessage"]]
        assert (await peer.ask("send_goal", CDR["SendGoal_Request"]))[:5] == HEADER + b"\x00"

        asking = asyncio.ensure_future(  # noqa: TID251  # beside the test
            peer.ask("get_result", CDR["GetResult_Request"])
        )
        may_end.set()
        assert await asking == CDR["GetResult_Response"]
        assert await peer.ask("get_result", CDR["GetResult_Request"]) == CDR["GetResult_Response"]
        while statuses((await status.have(1))[-1]) != [4]:
            await status.have(len(status.items) + 1)


async def until_asked(node: Node, feedback: Collector) -> None:
    """Wait until a publisher of the node knows the peer's subscription, by its first sample."""
    (publisher,) = (each for each in node.publishers if each.topic_name.endswith("/feedback"))
    while not feedback.items:
        publisher.publish(Fibonacci.Impl.FeedbackMessage())
        await asyncio.sleep(0.01)  # noqa: TID251  # a plain subscriber is not announced
    last = Fibonacci.Impl.FeedbackMessage(feedback=Fibonacci.Feedback(sequence=[1]))
    publisher.publish(last)  # after those that are under way
    while feedback.items[-1] != cdr.encode(last):
        await feedback.have(len(feedback.items) + 1)
    feedback.items.clear()


async def test_a_plain_client_cancels_a_goal(node: Node) -> None:
    """The answer lists the goal, and the result says CANCELED."""
    worker = Worker()
    node.create_action_server(
        Fibonacci, "fibonacci", worker, cancel_callback=lambda _goal: CancelResponse.ACCEPT
    )
    with raw_session() as session:
        peer = PlainPeer(session)
        await until_heard(peer)
        accepted = await peer.ask("send_goal", CDR["SendGoal_Request"])
        await worker.begun.get()

        answer = await peer.ask("cancel_goal", cancel_request(GOAL_ID))

        # int8 code, 3 bytes of padding, length, then id and stamp
        stamp = accepted[8:16]
        assert answer == HEADER + struct.pack("<b3xI", 0, 1) + GOAL_ID + stamp
        result = await peer.ask("get_result", CDR["GetResult_Request"])
        assert result == HEADER + struct.pack("<b3xI", GoalStatus.CANCELED, 0)
        late = await peer.ask("cancel_goal", cancel_request(GOAL_ID))
        assert late == HEADER + struct.pack("<b3xI", 3, 0)


async def until_heard(peer: PlainPeer) -> None:
    """Wait until the server hears the peer, whose query has no effect and may be repeated."""
    while True:
        with suppress(TimeoutError):
            async with asyncio.timeout(0.2):
                await peer.ask("get_result", HEADER + b"\x08" * 16)
                return


async def test_a_plain_client_gets_a_result_and_no_error_of_an_aborted_goal(node: Node) -> None:
    """ROS has no error replies: the reason goes only to aionode clients, which request it."""

    async def execute(_goal: Goal) -> Fibonacci.Result:
        raise LookupError("lost")

    node.create_action_server(Fibonacci, "fibonacci", execute)
    with raw_session() as session:
        peer = PlainPeer(session)
        await until_heard(peer)
        await peer.ask("send_goal", CDR["SendGoal_Request"])

        result = await peer.ask("get_result", CDR["GetResult_Request"])
        unknown = await peer.ask("get_result", HEADER + b"\x07" * 16)
        reason = await peer.ask("get_result", HEADER + bytes(byte ^ 255 for byte in GOAL_ID))

    assert result == HEADER + struct.pack("<b3xI", GoalStatus.ABORTED, 0)
    assert unknown == HEADER + struct.pack("<b3xI", GoalStatus.UNKNOWN, 0)
    assert json.loads(reason) == {"type": "AbortReason", "text": "LookupError: lost"}


# The client drives the peer


class PlainServer:
    """An action server made of queryables, publishers and tokens, with the vectors' bytes."""

    def __init__(self, session: zenoh.Session, result: bytes = CDR["GetResult_Response"]) -> None:
        self._session = session
        self._result = result
        self.asked: list[tuple[str, bytes]] = []
        self.waiting: list[zenoh.Query] = []
        self.accepts = True
        for part, one in ENDPOINTS.items():
            if one["kind"] == "service":
                session.declare_queryable(key(part), self._answering(part), complete=True)
        self._topics = {
            part: session.declare_publisher(key(part))
            for part, one in ENDPOINTS.items()
            if one["kind"] == "topic"
        }
        lv = f"@ros2_lv/{DOMAIN_ID}/{session.zid()}/0"
        self.tokens = [session.liveliness().declare_token(f"{lv}/0/NN/%/%/theirs")]
        for number, (part, one) in enumerate(ENDPOINTS.items(), start=1):
            kind = "SS" if one["kind"] == "service" else "MP"
            qos = ":1:,1:,:,:,," if part == "status" else "::,10:,:,:,,"
            self.tokens.append(
                session.liveliness().declare_token(
                    f"{lv}/{number}/{kind}/%/%/theirs/%fibonacci%_action%{part}/"
                    f"{one['dds_type']}/{one['rihs01']}/{qos}"
                )
            )

    def _answering(self, part: str) -> Any:
        def answer(query: zenoh.Query) -> None:
            assert query.payload is not None
            payload = query.payload.to_bytes()
            self.asked.append((part, payload))
            if part == "send_goal":
                self.reply(query, b"\x01" if self.accepts else b"\x00")
                if self.accepts:
                    self.publish("feedback", payload[4:20] + CDR["FeedbackMessage"][20:])
            elif part == "cancel_goal":
                self.reply(query, struct.pack("<b3xI", 0, 1) + payload[4:])
                self.finish(struct.pack("<b3xI", GoalStatus.CANCELED, 0))
            elif payload[4:20] == GOAL_ID:
                self.waiting.append(query)  # the goal runs on
            else:
                self.reply(query, self._result[4:])

        return answer

    def reply(self, query: zenoh.Query, body: bytes) -> None:
        """Answer; an acceptance needs its stamp."""
        if body in (b"\x01", b"\x00"):
            body += CDR["SendGoal_Response"][5:]
        query.reply(query.key_expr, HEADER + body, attachment=query.attachment)
        query.drop()

    def publish(self, part: str, body: bytes) -> None:
        """Send on a topic."""
        self._topics[part].put(HEADER + body, attachment=attachment(1))

    def finish(self, body: bytes) -> None:
        """Answer the pending requests for a result."""
        for query in self.waiting:
            self.reply(query, body)
        self.waiting.clear()


async def test_a_plain_server_is_driven_by_a_client(node: Node) -> None:
    """The request is the vector's, and so are feedback and result."""
    client = node.create_action_client(Fibonacci, "fibonacci")
    with raw_session() as session:
        server = PlainServer(session)
        await client.wait_for_server()

        goal = await client.send_goal(Fibonacci.Goal(order=5))
        heard = [feedback.sequence.tolist() async for feedback in goal]
        outcome = await goal.result()

        goal_id = bytes(goal.goal_id.uuid)
        assert server.asked[:2] == [
            ("send_goal", CDR["SendGoal_Request"].replace(GOAL_ID, goal_id)),
            ("get_result", CDR["GetResult_Request"].replace(GOAL_ID, goal_id)),
        ]
        assert heard == [[0, 1, 1]]
        assert outcome.status is GoalStatus.SUCCEEDED
        assert outcome.result.sequence.tolist() == [0, 1, 1, 2, 3, 5]
        assert goal.stamp.sec == 1_700_000_000


async def test_a_cancelled_caller_cancels_the_goal_of_a_plain_server(node: Node) -> None:
    """One request with the goal's id and no time."""
    client = node.create_action_client(Fibonacci, "fibonacci")
    with raw_session() as session:
        server = PlainServer(session)
        await client.wait_for_server()
        goal = await client.send_goal(Fibonacci.Goal(), goal_uuid=uuid_of(GOAL_NUMBER))

        with pytest.raises(TimeoutError):
            async with asyncio.timeout(0.1):
                await goal.result()

        assert (await goal.result()).status is GoalStatus.CANCELED
        assert ("cancel_goal", cancel_request(GOAL_ID)) in server.asked


GOAL_NUMBER = int.from_bytes(GOAL_ID, "big")


async def test_an_aborted_goal_of_a_plain_server_has_no_reason(node: Node) -> None:
    """Such a server treats the other id like any unknown goal."""
    client = node.create_action_client(Fibonacci, "fibonacci")
    with raw_session() as session:
        PlainServer(session, HEADER + struct.pack("<b3xI", GoalStatus.ABORTED, 0))
        await client.wait_for_server()
        goal = await client.send_goal(Fibonacci.Goal())
        outcome = await goal.result()

    assert (outcome.status, outcome.error_text) == (GoalStatus.ABORTED, "")


async def test_a_plain_server_that_goes_loses_the_goal(node: Node) -> None:
    """The query for the result ends with its session."""
    client = node.create_action_client(Fibonacci, "fibonacci")
    with raw_session() as session:
        server = PlainServer(session)
        await client.wait_for_server()
        goal = await client.send_goal(Fibonacci.Goal(), goal_uuid=uuid_of(GOAL_NUMBER))
        await anext(goal)
        server.waiting.clear()

    with pytest.raises(GoalLostError):
        await goal.result()
