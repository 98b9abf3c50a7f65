"""The event loop leaves Zenoh to threads while others have announced thousands of tokens.

Zenoh drops everything that a connection has announced at once, which blocks all puts.
"""

from __future__ import annotations

import asyncio
import threading
from collections.abc import AsyncIterator, Callable
from typing import Any

import pytest

from aionode.endpoints.publisher import Publisher
from aionode.engine.transport.send_thread import Worker
from aionode.engine.transport.zenoh import _session_state as session_state
from aionode.engine.transport.zenoh._defects import crowd
from aionode.engine.transport.zenoh._defects.crowd import CROWDED
from aionode.engine.transport.zenoh._session_state import SessionState
from aionode.engine.transport.zenoh.endpoints.publisher import ZenohWriter
from aionode.engine.transport.zenoh.endpoints.sender import ZenohSender
from aionode.engine.transport.zenoh.session import announced
from aionode.engine.transport.zenoh.session.announced import AnnouncedLimit
from aionode.engine.wire._key_expression import Side
from aionode.interfaces.std_msgs.msg import Int32
from aionode.qos import QoSProfile, ReliabilityPolicy
from tests.support.arrivals import writers_of
from tests.support.peers import quiet_node, two_contexts
from tests.support.waiting import until

PARTICIPANT = "a" * 32

BEST_EFFORT = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)


class Gate:
    """Blocks a publisher's thread, like Zenoh while it drops declarations."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.opened = threading.Event()
        send = ZenohSender._send

        def wait(self_: ZenohSender, *what: Any) -> None:
            self.opened.wait()
            send(self_, *what)

        monkeypatch.setattr(ZenohSender, "_send", wait)


def writer_of(publisher: Publisher[Int32]) -> ZenohWriter:
    """Return a publisher's end in Zenoh."""
    writer = writers_of(publisher)[1]
    assert isinstance(writer, ZenohWriter)
    return writer


def is_direct(writer: ZenohWriter) -> bool:
    """Return whether the loop itself puts messages into Zenoh, as without a crowd."""
    return writer.sender.puts_small_at_once


@pytest.fixture
async def state() -> AsyncIterator[SessionState]:
    """The state of a context without a session, in a crowd."""
    state = SessionState(PARTICIPANT, 42)
    state.waker.open(asyncio.get_running_loop())
    state.announced.left_out = 1
    state.announced.admit("other", "one more")
    assert state.control_messages.is_crowded
    yield state
    await state.bulk.flush()
    state.waker.close()


def test_there_is_a_crowd_while_more_than_some_thousand_tokens_are_kept() -> None:
    """Its start and its end are reported."""
    limit = AnnouncedLimit(64 << 20)
    told: list[bool] = []
    limit.on_crowded.append(lambda: told.append(limit.is_crowded))
    for number in range(CROWDED + 10):
        limit.admit(str(number % 10), str(number))
    for number in range(20):
        limit.release(str(number % 10), str(number))

    assert told == [True, False]


def test_there_is_a_crowd_while_anything_is_left_out() -> None:
    """Zenoh keeps that as well, and its amount is unknown."""
    limit = AnnouncedLimit(0)
    limit.admit("liar", "x" * announced.RESERVED_BYTES)
    assert limit.is_crowded

    limit.begin_to_fill()
    assert not limit.is_crowded


async def test_messages_wait_for_zenoh_in_a_thread_and_stay_in_order(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Even beyond the depth of their publisher, since no reader is slow."""
    gate = Gate(monkeypatch)
    async with (
        two_contexts(link=False) as (first, second),
        quiet_node("talker", first) as talker,
        quiet_node("listener", second) as listener,
    ):
        subscription = listener.create_subscription(Int32, "n", None, 500)
        publisher = talker.create_publisher(Int32, "n", 10)
        await publisher.wait_for_subscribers()
        limit = writer_of(publisher).state.announced
        publisher.publish(Int32(data=0))
        assert (await subscription.receive()).data == 0

        monkeypatch.setattr(crowd, "CROWDED", 0)
        limit.admit("other", "one more")
        for number in range(1, 101):
            publisher.publish(Int32(data=number))
        monkeypatch.setattr(crowd, "CROWDED", CROWDED)
        limit.release("other", "one more")
        for number in range(101, 111):  # Zenoh may be dropping the rest
            publisher.publish(Int32(data=number))
        assert len(writer_of(publisher).sender.large) == 110
        gate.opened.set()

        heard = [(await subscription.receive()).data for _ in range(110)]
        assert heard == list(range(1, 111))
        assert publisher.stats.dropped == 0


@pytest.mark.parametrize(
    "put",
    [
        lambda state: state.acknowledgements.send("key", Side.PUBLISHERS, "other", b"ack"),
        lambda state: state.assertions.send("key", bytes(16)),
        lambda state: state.cancellations.tell(["other"], "/service", bytes(16), 1),
        lambda state: state.peer_senders.send(["other"], 1, lambda: None),
    ],
    ids=["acknowledgement", "assertion", "cancellation", "request"],
)
async def test_all_else_waits_in_threads_too(
    state: SessionState, put: Callable[[SessionState], None], monkeypatch: pytest.MonkeyPatch
) -> None:
    """The loop puts nothing at all."""
    jobs: list[Any] = []
    with monkeypatch.context() as until_then:
        until_then.setattr(Worker, "submit", lambda _, job: jobs.append(job))

        put(state)
        assert len(jobs) == 1

        state.announced.begin_to_fill()
        put(state)
        assert len(jobs) == 1


async def test_the_loop_puts_again_a_while_after_the_crowd(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Zenoh reports the first token that it drops long before the last."""
    monkeypatch.setattr(session_state, "CALM_S", 0.05)
    async with quiet_node("talker") as talker:
        writer = writer_of(talker.create_publisher(Int32, "n", BEST_EFFORT))
        monkeypatch.setattr(crowd, "CROWDED", 0)
        writer.state.announced.admit("other", "one more")
        monkeypatch.setattr(crowd, "CROWDED", CROWDED)
        writer.state.announced.release("other", "one more")
        assert not is_direct(writer)
        await until(lambda: is_direct(writer))


async def test_a_publisher_that_is_made_in_a_crowd_uses_the_thread(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The crowd may have been there before the program."""
    monkeypatch.setattr(crowd, "CROWDED", 0)
    async with quiet_node("talker") as talker:
        before = writer_of(talker.create_publisher(Int32, "n", BEST_EFFORT))
        assert is_direct(before)
        before.state.announced.admit("other", "one more")
        late = writer_of(talker.create_publisher(Int32, "n", BEST_EFFORT))
        assert not is_direct(late)
        assert not is_direct(before)
