"""Which thread puts a publisher's messages into Zenoh."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from aionode.engine.transport.zenoh.connections.handlers import BULK_BYTES
from aionode.engine.transport.zenoh.endpoints.sender import LATE, SentBy, ZenohSender
from aionode.engine.transport.zenoh.endpoints.stop import ZenohStop
from aionode.interfaces.std_msgs.msg import Int8
from aionode.qos import DurabilityPolicy, HistoryPolicy, QoSProfile, ReliabilityPolicy

SMALL, LARGE = 100, BULK_BYTES
LAST = QoSProfile(depth=10)
ALL = QoSProfile(history=HistoryPolicy.KEEP_ALL)
BEST_EFFORT = QoSProfile(depth=10, reliability=ReliabilityPolicy.BEST_EFFORT)
LATCHED = QoSProfile(depth=10, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class Waiting:
    """A queue whose length a test sets."""

    def __init__(self, limit: int = 0) -> None:
        self.waiting, self.limit = 0, limit

    def __len__(self) -> int:
        return self.waiting


def sender(
    qos: QoSProfile, *, is_crowded: bool = False, has_room: bool = True, large: int = 0
) -> ZenohSender:
    """Return the sender of a publisher, as its session is now."""
    state: Any = SimpleNamespace(
        bulk=SimpleNamespace(send_queue=lambda limit, *_, **__: Waiting(limit)),
        waker=None,
        queue_bytes=1 << 20,
        queue=lambda _: None,
        control_messages=SimpleNamespace(is_crowded=is_crowded),
        burst=SimpleNamespace(spend=lambda _: has_room),
    )
    made = ZenohSender(state, "0/n", qos, lambda _: None)
    made.large.waiting = large  # type: ignore[attr-defined]  # a `Waiting`
    return made


@pytest.mark.parametrize(
    ("qos", "others", "options", "size", "sent_by"),
    [
        (LAST, False, {}, SMALL, SentBy.LOOP),
        (LAST, True, {}, SMALL, SentBy.LOOP),
        (LAST, True, {"has_room": False}, SMALL, SentBy.BLOCKING),
        (LAST, True, {"has_room": False}, LARGE, SentBy.BULK),
        (LAST, False, {"has_room": False}, SMALL, SentBy.LOOP),
        (LAST, False, {}, LARGE, SentBy.BULK),
        (LAST, False, {"large": 1}, SMALL, SentBy.BULK),
        (LAST, False, {"is_crowded": True}, SMALL, SentBy.BULK),
        (BEST_EFFORT, True, {"has_room": False}, SMALL, SentBy.LOOP),
        (ALL, True, {}, SMALL, SentBy.BLOCKING),
        (ALL, True, {}, LARGE, SentBy.BLOCKING),
        (ALL, False, {}, SMALL, SentBy.LOOP),
        (LATCHED, False, {}, SMALL, SentBy.BLOCKING),
    ],
)
def test_the_readers_of_a_message_decide_who_puts_it(
    qos: QoSProfile, others: bool, options: Any, size: int, sent_by: SentBy
) -> None:
    """The loop never waits, and no reader loses a message that must arrive."""
    made = sender(qos, **options)
    made.note_others(present=others)

    assert made.choose(size) is sent_by


@given(st.sampled_from([LAST, ALL, BEST_EFFORT, LATCHED]), *[st.booleans()] * 3, st.integers(0, 2))
def test_small_messages_skip_the_question_only_while_its_answer_is_known(
    qos: QoSProfile, others: bool, is_crowded: bool, has_room: bool, large: int
) -> None:
    """The short way and the question agree, before a message and after it."""
    made = sender(qos, is_crowded=is_crowded, has_room=has_room, large=large)
    made.note_others(present=others)
    for size in (SMALL, LARGE, SMALL):
        at_once = made.puts_small_at_once
        if size == SMALL:
            assert made.choose(size) is SentBy.LOOP or not at_once
        else:
            made.choose(size)


def test_a_crowd_lets_more_messages_wait() -> None:
    """While Zenoh drops declarations, messages wait for it, however short their queue."""
    crowded = sender(LAST, is_crowded=True)
    crowded.choose(SMALL)

    assert crowded.large.limit == LATE


@pytest.mark.parametrize("large", [0, 1])
def test_a_stop_is_sent_behind_the_large_messages_that_wait(large: int) -> None:
    """Each command may bring a stop of its own, however large the commands before it were."""
    writer: Any = SimpleNamespace(sender=sender(LAST, large=large))
    ZenohStop(writer, Int8(), bool)
    assert writer.sender.used_bulk == bool(large)
