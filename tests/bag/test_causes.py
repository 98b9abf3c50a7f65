"""Causes in bags: `why` answers from a recording what it answered while the robot ran."""

from __future__ import annotations

import json
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any

import msgspec
import pytest
from hypothesis import given
from hypothesis import strategies as st

from aionode import Context, Node, bag
from aionode.bag._writer import topic_info
from aionode.cli._main import main
from aionode.clock import Duration, Time
from aionode.engine.cause_reports import CauseQuestion, answer, encoded
from aionode.engine.causes import CauseLog
from aionode.engine.wire import cdr
from aionode.errors import BagError
from aionode.graph import NodeInfo
from aionode.interfaces.std_msgs.msg import Int32, String
from aionode.observe import (
    Caused,
    CauseRecorder,
    RecordedCauses,
    Why,
    _recorded,
    to_chains,
    why,
)
from aionode.qos import DurabilityPolicy, QoSProfile
from aionode.testing import local_context, settle
from tests.observe.test_observe import Answering
from tests.observe.test_why import names
from tests.support.peers import contexts_over, isolated

__all__ = ["isolated"]  # a fixture

CHANNEL = "/_aionode/causes"
LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


@asynccontextmanager
async def planner(context: Context) -> AsyncIterator[Node]:
    """A node that publishes ``drive`` for each ``map``."""
    async with Node("planner", context=context) as node:
        drive = node.create_publisher(Int32, "drive", LATCHED)

        def on_map(message: Int32) -> None:
            drive.publish(message)

        node.create_subscription(Int32, "map", on_map)
        yield node


async def plan(node: Node, number: int = 0) -> None:
    """Have the planner of another node drive once."""
    driven = node.create_subscription(Int32, "drive", qos_profile=LATCHED)
    publisher = node.create_publisher(Int32, "map", 10)
    await publisher.wait_for_subscribers()
    publisher.publish(Int32(data=number))
    while (await driven.receive()).data != number:
        pass


def known(found: Why) -> list[Any]:
    """Return an answer without its ages, which depend on the moment."""

    def of(sent: Caused) -> Any:
        causes = [
            (each.node, each.callback, each.waited_ns, each.ran_ns, each.source and of(each.source))
            for each in sent.causes
        ]
        return sent.kind, sent.name, sent.node, sent.gid, sent.sequence, sent.unknown, causes

    return [of(each) for each in found.sent]


async def record(path: Path, context: Context, **options: Any) -> Why:
    """Record one drive; return the live answer."""
    async with (
        planner(context) as node,
        bag.Recorder(path, topics=["/drive"], context=context, causes=True, **options),
    ):
        await plan(node)
        return await why(node, "/drive")


async def test_a_recording_answers_what_the_processes_have_answered(tmp_path: Path) -> None:
    """The same chain with the same times: the causes of a message never change."""
    async with Context(transport="local", causes=True) as context:
        live = await record(tmp_path / "run", context)
    with bag.open(tmp_path / "run") as run:
        found = bag.why(run, "drive")
        by_node = bag.why(run, "planner")

    assert names(found.sent[0]) == ["message /drive", "on_map", "message /map"]
    assert known(found) == known(live)
    assert [each.name for each in by_node.sent] == ["/drive", "/map"]


@pytest.mark.parametrize("way", ["local", "link"])
async def test_the_causes_of_several_processes_are_recorded(way: str, tmp_path: Path) -> None:
    """A third process asks both, like the recorder of a robot; its own nodes keep no causes."""
    async with (
        contexts_over(way, causes=True) as (one, other),
        Node("slam", context=one) as slam,
        planner(other),
        bag.Recorder(tmp_path / "run", topics=["/drive"], context=one, causes=True),
    ):
        await plan(slam)
        live = await why(slam, "/drive")
    with bag.open(tmp_path / "run") as run:
        found = bag.why(run, "/drive")

    assert known(found) == known(live)
    assert [cause.node for cause in found.sent[0].causes] == ["/planner"]
    assert found.sent[0].causes[0].source.node == "/slam"  # type: ignore[union-attr]


async def test_who_keeps_no_causes_is_named_with_the_remedy(tmp_path: Path) -> None:
    """As in the live answer, except the recorder itself."""
    async with local_context() as context:
        live = await record(tmp_path / "run", context)
    with bag.open(tmp_path / "run") as run:
        found = bag.why(run, "/drive")

    assert list(found.not_kept.values()) == [["/planner"]]
    assert known(found) == known(live)
    assert "AIONODE_CAUSES=1" in to_chains(found)
    assert "/drive (planner, keeps no causes)" in to_chains(found)


def looked(at_s: int, *sent_s: int) -> str:
    """Return the text of a query with messages of ``/t``; the other clock is 1000 s ahead."""
    gid = "AAAAAAAAAAAAAAAAAAAAAA=="
    sent = [["message", "publisher", "/n", "/t", gid, at, at * 10**9, []] for at in sent_s]
    return text_with(sent, now_ns=at_s * 10**9, time_ns=(at_s + 1000) * 10**9)


def text_with(sent: list[Any], **clocks: int) -> str:
    """Return the text of a query in which one process reports what it has sent."""
    report = {
        "participant": "p", "host": "h", "pid": 1, "program": "x", "clock": "c", "now_ns": 0,
        "is_kept": True, "sent": sent,
    }  # fmt: skip
    return json.dumps(clocks | {"report": report})


def test_what_is_kept_of_a_recording_has_a_bounded_size(monkeypatch: pytest.MonkeyPatch) -> None:
    """A compressed bag from a stranger may contain any number of causes with long names."""
    monkeypatch.setattr(_recorded, "MAX_BYTES", 1000)
    causes = RecordedCauses()
    for at_s in range(1, 100):
        assert causes.add(looked(at_s, at_s))

    assert sum(len(msgspec.json.encode(entry)) for entry, _ in causes._sent.values()) <= 1000
    assert causes.why("/t").sent[0].sequence == 99
    assert not causes.add(looked(100, 100).replace('"h"', f'"{"h" * 2000}"'))


def test_an_earlier_moment_can_be_asked_for(tmp_path: Path) -> None:
    """Later messages are left out, and ages count back from that moment, by default the end."""
    path = written(tmp_path / "run", looked(150, 100), looked(250, 200), looked(350))

    def latest(at: Time | Duration | None) -> list[tuple[int, int | None]]:
        with bag.open(path) as run:
            sent = bag.why(run, "/t", at).sent
        return [(each.sequence, each.ago_ns and each.ago_ns // 10**9) for each in sent]

    assert latest(None) == [(200, 150)]
    assert latest(Time(nanoseconds=1190 * 10**9)) == [(100, 90)]
    assert latest(Time(nanoseconds=1050 * 10**9)) == []
    assert latest(Duration(seconds=60)) == [(200, 10)]  # the bag begins with the first look
    assert latest(Duration(seconds=600)) == [(200, 550)]


async def test_the_channel_is_not_played(tmp_path: Path) -> None:
    """Nodes that listen to the player would take old causes for new ones."""
    async with Context(transport="local", causes=True) as context:
        await record(tmp_path / "run", context)
    async with local_context() as context, bag.Player(tmp_path / "run", context=context) as player:
        topics = {each.name for each in player.node.graph.endpoints()}
        await player.play()
        assert player.played == 1
    assert "/drive" in topics
    assert CHANNEL not in topics


async def test_nobody_else_writes_into_the_channel(tmp_path: Path) -> None:
    """A message published on its topic is not recorded, whatever is selected."""
    selection = bag.Selection(every=["topic"], hidden=True, topics=[CHANNEL])
    async with local_context() as context, Node("evil", context=context) as node:
        publisher = node.create_publisher(String, CHANNEL, 10)
        async with bag.Recorder(tmp_path / "run", selection=selection, context=context):
            publisher.publish(String(data="{}"))
            await settle()
    with bag.open(tmp_path / "run") as run:
        assert CHANNEL not in run.topics


async def test_other_programs_read_the_channel_as_text(tmp_path: Path) -> None:
    """Its messages are std_msgs/String with JSON, and it is listed like any topic."""
    async with Context(transport="local", causes=True) as context:
        await record(tmp_path / "run", context)
    with bag.open(tmp_path / "run") as run:
        assert run.topics[CHANNEL].type == "std_msgs/msg/String"
        told = [json.loads(each.message.data) for each in run.read(CHANNEL)]
    assert {name for each in told for names in each["named"].values() for name in names} == {
        "/planner"
    }


async def test_stopping_by_service_records_the_last_causes(tmp_path: Path) -> None:
    """`stop` closes the bag before the recorder ends."""
    async with (
        Context(transport="local", causes=True) as context,
        planner(context) as node,
        bag.Recorder(tmp_path / "run", topics=["/drive"], context=context, causes=True) as recorder,
    ):
        await plan(node)
        live = await why(node, "/drive")
        await recorder.stop()
    with bag.open(tmp_path / "run") as run:
        assert known(bag.why(run, "/drive")) == known(live)


def written(path: Path, *texts: str, msg_type: Any = String) -> str:
    """Return a bag with these messages in the channel, 100 s apart."""
    with bag.BagWriter(path) as out:
        number = out.add_topic(topic_info(CHANNEL, msg_type))
        for place, text in enumerate(texts):
            message = String(data=text) if msg_type is String else msg_type()
            out.write(number, (1150 + 100 * place) * 10**9, cdr.encode(message))
    return str(path)


def test_a_bag_without_causes_is_one_error_with_the_remedy(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """It names the option to record with."""
    with bag.BagWriter(tmp_path / "run"):
        pass
    assert main(["why", "/drive", "--from", str(tmp_path / "run")]) == 1
    assert "record with `aionode bag record --causes`" in capsys.readouterr().err


@pytest.mark.parametrize(
    "command", [["why", "/drive", "--from"], ["topic", "plot", "/a.b", "--bag"]]
)
def test_a_bag_that_is_not_there_is_one_line(
    command: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    """As for the commands of `aionode bag`."""
    assert main([*command, "/nowhere/run"]) == 1
    assert capsys.readouterr().err.endswith("bag /nowhere/run: there is no such file or folder\n")


@pytest.mark.parametrize(
    "text",
    [
        "",
        "{",
        "[]",
        '{"now_ns": "soon", "time_ns": 0}',
        '{"now_ns": 1e400, "time_ns": 0}',
        f'{{"now_ns": {10**30}, "time_ns": 0}}',
        "[" * 10**5,
    ],
)
def test_a_damaged_channel_is_one_error(tmp_path: Path, text: str) -> None:
    """It says where, and that another version may have written it."""
    with (
        bag.open(written(tmp_path / "run", text)) as run,
        pytest.raises(
            BagError,
            match=r"at 1150\.000000000 cannot be read; it is damaged, or another version",
        ),
    ):
        bag.why(run, "/drive")


def test_a_channel_of_another_type_is_the_same_error(tmp_path: Path) -> None:
    """Only texts are read."""
    path = written(tmp_path / "run", "", msg_type=Int32)
    with bag.open(path) as run, pytest.raises(BagError, match="cannot be read"):
        bag.why(run, "/drive")


async def test_the_command_answers_from_a_bag(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """It prints the same lines without a node; its exit status is 1 if nothing is known."""
    async with Context(transport="local", causes=True) as context:
        await record(tmp_path / "run", context)
    path = str(tmp_path / "run")
    capsys.readouterr()

    assert main(["why", "/drive", "--from", path]) == 0
    assert " ← planner.on_map (run " in capsys.readouterr().out
    assert main(["why", "drive", "--from", path, "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["sent"][0]["name"] == "/drive"
    assert main(["why", "/nowhere", "--from", path]) == 1
    assert "/nowhere: nothing is known to have been sent under this name" in capsys.readouterr().out
    assert main(["why", "/drive", "--at", "1"]) == 2
    assert "--from BAG" in capsys.readouterr().err


@given(
    st.lists(
        st.tuples(st.integers(0, 3), st.integers(0, 3), st.integers(-(2**63), 2**63 - 1)),
        max_size=12,
    )
)
def test_any_recording_is_answered(links: list[tuple[int, int, int]]) -> None:
    """Even with circular causes and nonsensical times, since a bag may come from anyone."""
    gids = ["AAAAAAAAAAAAAAAAAAAAAA==", "BBBBBBBBBBBBBBBBBBBBBB=="]

    def run(number: int, at_ns: int) -> list[Any]:
        gid = gids[number % 2]
        return ["message", "subscription", "/n\x1b", "/t", "f", gid, number, at_ns, -at_ns - 1, 0]

    sent = [
        ["message", "publisher", "/n", "/t", gids[to % 2], to, at_ns, [run(by, at_ns)] * 9]
        for to, by, at_ns in links
    ]
    causes = RecordedCauses()
    assert causes.add(text_with(sent, now_ns=2**63 - 1, time_ns=0))

    found = causes.why("/t")

    assert len(found.sent) <= 1
    assert "\x1b" not in to_chains(found)


async def test_each_look_has_what_is_new(tmp_path: Path) -> None:
    """An hour of recording does not repeat the same causes for an hour."""
    async with Context(transport="local", causes=True) as context, planner(context) as node:
        recorder = CauseRecorder(node)
        await plan(node)
        first = await recorder.texts()
        second = await recorder.texts()
    assert '"/drive"' in first[0]
    assert json.loads(second[0])["report"]["sent"] == []


async def test_who_cannot_tell_is_named_and_spoils_no_recording() -> None:
    """Frozen and older processes, and answers that a reader of the recording could not decode."""
    far = answer(CauseLog(), "d4", CauseQuestion())
    far.clock, far.now_ns = "another", 2**64 - 1
    transport = Answering({"a1": None, "b2": b"", "c3": b"\xff", "d4": encoded(far)})
    causes = RecordedCauses()
    async with (
        Context(transport=transport, causes=True) as context,
        Node("robot", context=context) as node,
    ):
        for participant in ("a1", "b2", "c3", "d4"):
            node.graph.add_node(NodeInfo(participant, 1, f"of_{participant}", "/"))
        node.create_publisher(Int32, "out", 10).publish(Int32())
        recorder = CauseRecorder(node)
        for text in await recorder.texts():
            assert causes.add(text)

    found = causes.why("/out")

    assert names(found.sent[0]) == ["message /out"]
    assert (found.silent, found.older) == ({"a1": ["/of_a1"]}, {"b2": ["/of_b2"]})
    assert found.unreadable == {"c3": ["/of_c3"], "d4": ["/of_d4"]}
