"""The ways of a message to its callback are written out for speed, and have to agree."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Final

from hypothesis import given, settings
from hypothesis import strategies as st

from aionode._process.concurrency import checkpoint
from aionode.clock import perf_ns
from aionode.engine.transport.base import NOT_INLINE_NS
from aionode.interfaces.std_msgs.msg import Int32
from aionode.node import Node
from aionode.qos import HistoryPolicy, QoSProfile
from aionode.testing import local_context, settle
from tests.support.arrivals import reader_of

if TYPE_CHECKING:
    from aionode.endpoints.subscription import MessageInfo

GID: Final = bytes(16)

SYNC: Final = ("nothing", "value", "raises", "stops", "cancels")
"""The actions of a callback on a message: the last three raise ValueError and so on."""

AWAITS: Final = ("awaits", "raises later")
"""Further actions of a callback that does not run in a thread."""

ERRORS: Final = {"raises": ValueError, "stops": StopIteration, "cancels": asyncio.CancelledError}


@dataclass(frozen=True)
class Way:
    """A way of messages to a callback.

    Attributes:
        deadline_ns: `inline_deadline_ns`, or a function that returns it.
        wants_info: Whether the callback takes the message's info.
        is_filtered: Whether a content filter lets all messages pass.
        options: Of the subscription.
    """

    deadline_ns: Callable[[], int] = lambda: 0
    wants_info: bool = False
    is_filtered: bool = False
    options: dict[str, Any] = field(default_factory=dict)


def later() -> int:
    """Return a time before which any callback ends."""
    return perf_ns() + 60 * 10**9


WAYS: Final = {
    "inline": Way(later),
    "inline, with info": Way(later, wants_info=True),
    "inline, filtered": Way(later, is_filtered=True),
    "queued": Way(),
    "queued, of another process": Way(lambda: NOT_INLINE_NS),
    "queued, with info": Way(wants_info=True),
    "queued, filtered": Way(is_filtered=True),
    "one task at a time": Way(options={"concurrent": 1}),
}
"""All but those by a thread, which cannot await, and those past the queue of a `DirectReader`."""


@dataclass
class Seen:
    """What a subscription and its callback have seen.

    Attributes:
        calls: The messages, in the order of the calls.
        ended: Those whose callback has ended without an error.
        errors: What `on_error` got.
        counts: What the statistics say.
        lost: How many messages they say are lost: none with a filter.
    """

    calls: list[int] = field(default_factory=list)
    ended: list[int] = field(default_factory=list)
    errors: list[str] = field(default_factory=list)
    counts: dict[str, int] = field(default_factory=dict)
    lost: int = field(default=0, compare=False)


class Listener:
    """Has the callback, which treats each message according to its number."""

    def __init__(self, scripts: list[str]) -> None:
        self.seen = Seen()
        self._scripts = scripts

    def callback(self, msg: Int32) -> object:
        """Take a message."""
        self.seen.calls.append(msg.data)
        script = self._scripts[msg.data]
        if script in ERRORS:
            raise ERRORS[script](str(msg.data))
        if script in AWAITS:
            return self._work(msg.data, script)
        self.seen.ended.append(msg.data)
        return msg.data if script == "value" else None

    def with_info(self, msg: Int32, info: MessageInfo) -> object:
        """Take a message and its info."""
        assert info["publisher_gid"] == GID
        return self.callback(msg)

    async def _work(self, number: int, script: str) -> None:
        await checkpoint()
        if script == "raises later":
            raise ValueError(str(number))
        self.seen.ended.append(number)

    def note_error(self, error: Exception, _: object) -> None:
        """Keep an error, whose text may name the callback."""
        text = str(error).replace("with_info", "callback")
        self.seen.errors.append(f"{type(error).__name__}: {text}")


async def take(way: Way, bursts: list[list[str]], qos: QoSProfile | int = 1000) -> Seen:
    """Return the outcome of messages that are delivered in bursts.

    Args:
        way: Their way to the callback.
        bursts: What the callback does with each of those that come within one event. Two messages
            are missing after each burst.
        qos: The profile of the subscription.
    """
    listener = Listener([script for burst in bursts for script in burst])
    callback = listener.with_info if way.wants_info else listener.callback
    async with local_context() as context:
        node = Node("listener", context=context)
        subscription = node.create_subscription(
            Int32, "numbers", callback, qos, on_error=listener.note_error, **way.options
        )
        if way.is_filtered:
            subscription.set_content_filter("data >= 0")
        async with node:
            await settle()
            number, deliver = 0, reader_of(subscription).deliver
            for missing, burst in enumerate(bursts):
                deadline_ns = way.deadline_ns()
                for _ in burst:
                    sequence = 1 + number + 2 * missing
                    deliver(Int32(data=number), GID, sequence, 0, deadline_ns)
                    number += 1
                await settle()
        stats, seen = subscription.stats, listener.seen
        seen.lost = stats.lost
        seen.counts = {name: getattr(stats, name) for name in ("received", "dropped", "errors")}
        for name in ("queue_wait", "run_time", "blocking"):
            seen.counts[name] = getattr(stats, name).count
    return seen


def bursts_of(*scripts: str) -> st.SearchStrategy[list[list[str]]]:
    """Return a strategy for messages that come in bursts."""
    return st.lists(st.lists(st.sampled_from(scripts), min_size=1, max_size=5), max_size=4)


@given(bursts_of(*SYNC, *AWAITS))
@settings(deadline=None)
def test_all_ways_to_a_callback_agree(bursts: list[list[str]]) -> None:
    """They call it with the same messages, and tell the same of its errors and times."""

    async def run() -> dict[str, Seen]:
        return {name: await take(way, bursts) for name, way in WAYS.items()}

    seen = asyncio.run(run())
    expected = seen["queued"]
    assert seen == dict.fromkeys(WAYS, expected)
    assert expected.counts["received"] == len(expected.calls) == sum(map(len, bursts))
    lost = 2 * max(len(bursts) - 1, 0)
    assert {name: each.lost for name, each in seen.items()} == {
        name: 0 if way.is_filtered else lost for name, way in WAYS.items()
    }


@given(bursts_of("nothing", "value", "raises", "stops"))
@settings(deadline=None)
def test_a_thread_agrees_but_for_what_threads_cannot_raise(bursts: list[list[str]]) -> None:
    """A future accepts no StopIteration, so there it is a RuntimeError."""

    async def run() -> tuple[Seen, Seen]:
        thread = Way(options={"offload": True})
        return await take(WAYS["queued"], bursts), await take(thread, bursts)

    queued, offloaded = asyncio.run(run())
    assert offloaded.calls == queued.calls
    assert offloaded.ended == queued.ended
    assert offloaded.counts == queued.counts
    assert len(offloaded.errors) == len(queued.errors)


@given(st.integers(1, 5), st.integers(0, 8), st.booleans())
@settings(deadline=None)
def test_a_full_queue_drops_the_same_of_all_messages(
    depth: int, count: int, keep_all: bool
) -> None:
    """Messages come from this process or another, and are read with their info or without."""
    history = HistoryPolicy.KEEP_ALL if keep_all else HistoryPolicy.KEEP_LAST
    profile = QoSProfile(depth=depth, history=history)
    queued = {name: way for name, way in WAYS.items() if not name.startswith("inline")}

    async def run() -> dict[str, Seen]:
        return {
            name: await take(way, [["nothing"] * count], profile) for name, way in queued.items()
        }

    seen = asyncio.run(run())
    expected = seen["queued"]
    assert seen == dict.fromkeys(queued, expected)
    assert expected.counts["dropped"] == (0 if keep_all else max(count - depth, 0))
