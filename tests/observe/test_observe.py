"""What all processes of a system count, asked from one of them."""

from __future__ import annotations

import asyncio
import os
import signal
import subprocess
from collections.abc import Collection

import pytest
from hypothesis import given
from hypothesis import strategies as st

from aionode import Context, Node
from aionode.engine.observation import decoded, encoded
from aionode.engine.transport.local import LocalTransport
from aionode.engine.transport.zenoh.discovery import observed
from aionode.graph import NodeInfo
from aionode.interfaces.std_msgs.msg import Int32
from aionode.observe import Snapshot, observe, rates
from aionode.testing import local_context, settle
from tests.support.fork_server import start
from tests.support.peers import quiet_node, two_contexts

PATIENCE_S = 20.0
"""Time in which processes find each other, in seconds."""


class Answering(LocalTransport):
    """A transport behind which other contexts answer as a test says."""

    def __init__(self, answers: dict[str, bytes | None]) -> None:
        super().__init__()
        self.answers = answers

    async def observe(
        self,
        what: str,
        question: bytes,
        timeout_s: float,
        participants: Collection[str] | None = None,
    ) -> dict[str, bytes | None]:
        """Return what the test says."""
        return self.answers


def entity(snapshot: Snapshot, kind: str, name: str = "") -> dict[str, int]:
    """Return the counts of the only entity of a kind and name."""
    (found,) = [
        entity
        for process in snapshot.processes
        for node in process.nodes
        for entity in node.entities
        if entity.kind == kind and entity.name == name
    ]
    return found.counts


async def test_the_counts_are_those_of_the_endpoints() -> None:
    """Nothing is counted twice, or for the tool alone; infrastructure is left out."""
    async with Node("robot", context=local_context()) as node:
        publisher = node.create_publisher(Int32, "numbers", 10)
        node.create_subscription(Int32, "numbers", lambda _: None)
        before = await observe(node)
        for number in range(5):
            publisher.publish(Int32(data=number))
        await settle()
        after = await observe(node)

    assert entity(before, "publisher", "/numbers")["published"] == 0
    assert entity(after, "publisher", "/numbers")["published"] == 5
    assert entity(after, "subscription", "/numbers")["received"] == 5
    (process,) = after.processes
    assert process.pid == os.getpid()
    assert [each.name for each in process.nodes[0].entities] == ["/numbers", "/numbers"]


async def test_two_snapshots_give_rates() -> None:
    """By the clock of each process, with the durations of what happened between them."""
    async with Node("robot", context=local_context()) as node:
        publisher = node.create_publisher(Int32, "numbers", 10)
        node.create_subscription(Int32, "numbers", lambda _: None)
        publisher.publish(Int32())
        await settle()
        before = await observe(node)
        for number in range(10):
            publisher.publish(Int32(data=number))
        await settle()
        after = await observe(node)
    before.processes[0].now_ns = after.processes[0].now_ns - 2_000_000_000

    found = rates(before, after)

    assert found.topic_hz() == {"/numbers": pytest.approx(5.0)}
    (heard,) = [each for each in found.entities() if each.report.kind == "subscription"]
    assert heard.hz == pytest.approx(5.0)
    assert heard.new["received"] == 10
    assert heard.durations["run_time"].count == 10


async def test_contexts_that_do_not_answer_are_named_and_the_others_are_included() -> None:
    """A process that is frozen, dead, older, or of another form; ROS 2 keeps no reports."""
    told = encoded((context := local_context()).report())
    answers = {"a1": None, "b2": b"", "c3": b"\xff", "d4": told, "e5": None}
    async with Node("robot", context=Context(transport=Answering(answers))) as node:
        for number, (participant, name) in enumerate(
            [("a1", "frozen"), ("b2", "older"), ("c3", "newer"), ("f6", "of_ros"), ("a1", "_tool")]
        ):
            node.graph.add_node(NodeInfo(participant, number, name, "/"))
        found = await observe(node)

    assert found.silent == {"a1": ["/frozen"]}
    assert found.older == {"b2": ["/older"]}
    assert found.unreadable == {"c3": ["/newer"]}
    assert found.foreign == ["/of_ros"]
    assert [process.participant for process in found.processes] == [
        node.context.participant,
        context.participant,
    ]


@given(st.binary(max_size=300))
def test_an_invalid_report_is_refused(data: bytes) -> None:
    """What other processes send is not trusted."""
    report = decoded(data)

    assert report is None or encoded(report)


async def test_an_answer_that_is_too_large_counts_as_none(monkeypatch: pytest.MonkeyPatch) -> None:
    """However much the contexts of a network say, the asker keeps a bounded part of it."""
    monkeypatch.setattr(observed, "MAX_BYTES", observed.ANSWER_BYTES)
    async with two_contexts() as (one, other):
        robot = quiet_node("robot", one)
        tool = quiet_node("tool", other)
        async with robot, tool:
            await tool.graph.until(lambda: len(tool.graph.nodes()) == 2)

            found = await observe(tool)

    assert [process.participant for process in found.processes] == [other.participant]
    assert "/robot" in str(found.silent | found.older)


async def test_contexts_answer_each_other_over_the_network() -> None:
    """Over Zenoh, whatever else connects them; hidden nodes of tools are left out."""
    async with two_contexts() as (one, other):
        robot = quiet_node("robot", one)
        tool = quiet_node("_tool", other)
        async with robot, tool:
            robot.create_publisher(Int32, "numbers", 10).publish(Int32())
            await tool.graph.until(lambda: tool.count_publishers("/numbers") == 1)

            found = await observe(tool)

    assert entity(found, "publisher", "/numbers")["published"] == 1
    assert [node.name for process in found.processes for node in process.nodes] == ["/robot"]
    assert (found.silent, found.older, found.unreadable) == ({}, {}, {})


@pytest.mark.processes
@pytest.mark.one_loop
@pytest.mark.parametrize("link", ["on", "off"])
async def test_a_stopped_process_is_named_and_delays_nobody(
    monkeypatch: pytest.MonkeyPatch, link: str
) -> None:
    """The report of the others is there within the time limit, with links or without."""
    monkeypatch.setenv("AIONODE_LINK", link)
    talker = start(
        ["examples/talker.py"],
        env=dict(os.environ),
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    try:
        async with quiet_node("watching") as node:
            node.create_publisher(Int32, "numbers", 10)
            async with asyncio.timeout(PATIENCE_S):
                await node.graph.until(lambda: node.count_publishers("/chatter") == 1)
                while len((before := await observe(node)).processes) < 2:
                    pass  # its nodes are known before it can be asked
                talker.send_signal(signal.SIGSTOP)
                after = await observe(node)
    finally:
        talker.send_signal(signal.SIGCONT)
        talker.kill()
        talker.wait()

    assert entity(before, "timer")["errors"] == 0
    assert list(after.silent.values()) == [["/talker"]]
    assert entity(after, "publisher", "/numbers")["published"] == 0
