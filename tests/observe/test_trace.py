"""Traces: callbacks of several processes on one axis of time, with arrows."""

from __future__ import annotations

import asyncio
import json
from itertools import count
from pathlib import Path
from typing import Any, Final

import pytest
from hypothesis import given
from hypothesis import strategies as st

from aionode import Context, Node
from aionode.cli._nouns.trace import record
from aionode.cli._support.output import Output
from aionode.engine.cause_reports import CauseQuestion, answer, encoded
from aionode.engine.causes import CauseLog
from aionode.graph import NodeInfo
from aionode.interfaces.std_msgs.msg import Int32
from aionode.observe import _trace, record_trace
from aionode.testing import local_context
from tests.observe.test_observe import Answering
from tests.support.peers import contexts_over

REQUIRED: Final = {
    "M": {"name", "pid", "tid", "args"},
    "X": {"name", "cat", "pid", "tid", "ts", "dur", "args"},
    "s": {"name", "cat", "id", "pid", "tid", "ts"},
    "t": {"name", "cat", "id", "pid", "tid", "ts", "bp"},
    "f": {"name", "cat", "id", "pid", "tid", "ts", "bp"},
}
"""The fields of each phase in the trace event format, which Perfetto and Chrome read."""


async def traced(way: str) -> Any:
    """Return the trace of a talker and a listener, which sends the same on."""
    async with (
        contexts_over(way, causes=True) as (a, b),
        Node("talker", context=a) as talker,
        Node("listener", context=b) as listener,
    ):
        publisher = talker.create_publisher(Int32, "numbers", 10)
        answers = listener.create_publisher(Int32, "answers", 10)

        def on_tick() -> None:
            publisher.publish(Int32())

        async def on_number(message: Int32) -> None:
            await asyncio.to_thread(lambda: None)
            answers.publish(message)

        listener.create_subscription(Int32, "numbers", on_number)
        await publisher.wait_for_subscribers()
        talker.create_timer(0.01, on_tick)
        trace = await record_trace(talker, 0.3)
        while trace.callbacks + trace.lost < 20:  # the machine is busy
            trace = await record_trace(talker, 1.0)
        return trace


@pytest.mark.parametrize("way", ["local", "link"])
async def test_callbacks_and_arrows_are_true(way: str) -> None:
    """An arrow goes from what a callback sent to the callback that took it, never back in time."""
    trace = await traced(way)

    events = trace.events
    slices = [each for each in events if each["ph"] == "X"]
    named = {each["name"] for each in slices}
    assert {"on_tick", "on_number", "message /numbers", "message /answers"} <= named
    assert (trace.lost, trace.not_kept, trace.silent, trace.older) == (0, {}, {}, {})
    calls = [each for each in slices if each["cat"] != "sent"]
    assert trace.callbacks == len(calls)
    starts = {each["id"]: each for each in events if each["ph"] == "s"}
    ends = [each for each in events if each["ph"] in "tf"]
    assert len(ends) > 5
    assert all(REQUIRED[each["ph"]] <= each.keys() for each in events)
    assert min(each["ts"] for each in slices) == 0
    for end in ends:
        start = starts[end["id"]]
        # A link may deliver before the sender goes on and notes what it sent, but never before the
        # callback that sent it was called.
        sender = next(
            call
            for call in calls
            if call["name"] == "on_tick"
            and call["tid"] == start["tid"]
            and call["ts"] <= start["ts"] <= call["ts"] + call["dur"] + 0.001
        )
        assert end["ts"] >= (start["ts"] if way == "local" else sender["ts"])
        assert any(
            call["tid"] == end["tid"] and call["ts"] == end["ts"] and call["name"] == "on_number"
            for call in calls
        )
    for one in calls:  # on one track, none overlaps the next
        for other in calls:
            if one is not other and one["tid"] == other["tid"] and one["ts"] <= other["ts"]:
                assert other["ts"] >= one["ts"] + one["dur"] - 0.001


@pytest.mark.parametrize("limit", ["MAX_EVENTS", "MAX_BYTES"])
async def test_a_trace_is_bounded_and_counts_what_does_not_fit(
    limit: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """By number and by size: others choose the names of their nodes and callbacks."""
    monkeypatch.setattr(_trace, limit, 0)
    trace = await traced("local")

    assert trace.callbacks == 0
    assert trace.lost > 10


@given(st.lists(st.tuples(st.integers(0, 50), st.integers(0, 20)), max_size=30))
def test_callbacks_take_the_first_track_that_is_free(calls: list[tuple[int, int]]) -> None:
    """None overlaps another on its track, and there are no more tracks than are needed at once."""
    lanes = _trace.Lanes()
    taken: list[tuple[int, int, int]] = []
    for began, duration in sorted(calls):
        ended = began + duration
        busy = {lane for _, end, lane in taken if end > began}
        lane = lanes.take(began, ended)
        assert lane == next(free for free in count() if free not in busy)
        taken.append((began, ended, lane))


async def test_a_context_that_counts_backwards_hides_no_loss() -> None:
    """Its numbers made the count of what was lost negative."""
    report = answer(CauseLog(), "d4", CauseQuestion())
    report.next = 100, 100
    async with (
        Context(transport=Answering({"d4": encoded(report)}), causes=True) as context,
        Node("robot", context=context) as node,
    ):
        assert (await record_trace(node, 0.01)).lost == 0


async def test_a_context_without_nodes_is_not_named_silent() -> None:
    """It has just ended, or is a tool."""
    async with (
        Context(transport=Answering({"a1": None, "b2": None}), causes=True) as context,
        Node("robot", context=context) as node,
    ):
        node.graph.add_node(NodeInfo("a1", 1, "frozen", "/"))
        trace = await record_trace(node, 0.01)

    assert trace.silent == {"a1": ["/frozen"]}


async def test_the_command_writes_a_file_and_names_processes_left_out(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """With the remedy; the exit status is 1 where nobody does."""
    path = tmp_path / "trace.json"
    async with Node("robot", context=local_context()) as node:
        status = await record(node, path, output=Output(), duration=0.01)

    assert status == 1
    assert json.loads(path.read_bytes())["traceEvents"] == []
    assert (
        "/robot: callbacks are not recorded: start it with AIONODE_CAUSES=1"
        in capsys.readouterr().out
    )
