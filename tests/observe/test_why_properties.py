"""Whatever callbacks do, each message has the causes that it really had, and no others."""

from __future__ import annotations

import asyncio
from typing import Any, Literal, NamedTuple

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from aionode import Context, Node
from aionode._process.concurrency import checkpoint
from aionode.engine.cause_reports import CauseQuestion, answer, asked, decoded, encoded
from aionode.engine.causes import MAX_KEPT, CauseLog, Party
from aionode.graph import EndpointKind
from aionode.interfaces.std_msgs.msg import String
from aionode.observe import Caused, why
from aionode.testing import settle

TOPICS = 5

How = Literal["at once", "later", "in a task", "in a group", "in a thread", "by the loop"]


class Step(NamedTuple):
    """Something that a callback does.

    Attributes:
        topic: The topic to which it publishes.
        how: In which way.
        turns: For how many turns of the loop it waits first.
    """

    topic: int
    how: How
    turns: int


class Callback(NamedTuple):
    """A subscription of a topic: what its callback does, and how it is called."""

    steps: list[Step]
    options: dict[str, Any]
    is_sync: bool


@st.composite
def programs(draw: st.DrawFn) -> list[list[Callback]]:
    """Callbacks for each topic, which publish to later topics only."""
    found = []
    for topic in range(TOPICS):
        step = st.builds(
            Step,
            st.integers(topic + 1, TOPICS),
            st.sampled_from(How.__args__),  # type: ignore[attr-defined]  # of a Literal
            st.integers(0, 3),
        )
        options = st.sampled_from([{}, {"concurrent": True}, {"concurrent": 2}])
        callback = st.builds(Callback, st.lists(step, max_size=2), options, st.booleans())
        found.append(draw(st.lists(callback, max_size=2)))
    return found


class Program:
    """Runs such callbacks, and keeps for itself what caused each message."""

    def __init__(self, node: Node, program: list[list[Callback]]) -> None:
        self.publishers = [node.create_publisher(String, f"t{n}", 1000) for n in range(TOPICS + 1)]
        self.names = {publisher.topic_name for publisher in self.publishers}
        self.expected: dict[tuple[str, int], tuple[str, int] | None] = {}
        self.tasks: set[asyncio.Task[None]] = set()
        for topic, callbacks in enumerate(program):
            for callback in callbacks:
                self.subscribe(node, topic, callback)

    def publish(self, topic: int, cause: str) -> None:
        """Publish a message that says what caused it."""
        publisher = self.publishers[topic]
        name, sequence = publisher.topic_name, publisher.stats.published + 1
        before = cause.split()
        self.expected[name, sequence] = (before[0], int(before[1])) if before else None
        publisher.publish(String(data=f"{name} {sequence}"))

    def subscribe(self, node: Node, topic: int, callback: Callback) -> None:
        """Create a subscription."""

        async def take(message: String) -> None:
            for step in callback.steps:
                for _ in range(step.turns):
                    await checkpoint()
                await self.do(step, message.data)

        def take_sync(message: String) -> None:
            for step in callback.steps:
                if step.how == "at once":
                    self.publish(step.topic, message.data)
                else:
                    asyncio.get_running_loop().call_soon(self.publish, step.topic, message.data)

        on_message = take_sync if callback.is_sync else take
        node.create_subscription(String, f"t{topic}", on_message, 1000, **callback.options)

    async def do(self, step: Step, cause: str) -> None:
        """Publish in one of the ways."""

        async def later() -> None:
            await checkpoint()
            self.publish(step.topic, cause)

        if step.how == "at once":
            self.publish(step.topic, cause)
        elif step.how == "later":
            await later()
        elif step.how == "in a task":
            await asyncio.gather(later(), checkpoint())
        elif step.how == "in a group":
            async with asyncio.TaskGroup() as tasks:
                tasks.create_task(later())
        elif step.how == "in a thread":
            await asyncio.to_thread(lambda: None)
            self.publish(step.topic, cause)
        else:
            asyncio.get_running_loop().call_soon(self.publish, step.topic, cause)


@pytest.mark.slow
@pytest.mark.hypothesis
@settings(max_examples=60, deadline=None)
@given(programs(), st.integers(1, 4))
def test_causes_are_those_that_messages_had(program: list[list[Callback]], messages: int) -> None:
    """None is false, and none is missing within what is kept."""

    async def run() -> None:
        async with (
            Context(transport="local", causes=True) as context,
            Node("robot", context=context) as node,
        ):
            running = Program(node, program)
            for _ in range(messages):
                running.publish(0, "")
            await settle()
            log = context.causes
            assert log is not None
            of_gid = {each.gid: each.name for each in node.graph.endpoints(EndpointKind.PUBLISHER)}
            told = {
                (sent.party.name, sent.sequence): [
                    (of_gid[run.gid], run.sequence) for run in sent.causes
                ]
                for sent in log.sent
                if sent.party.name in running.names
            }
            assert len(running.expected) < MAX_KEPT
            assert told == {
                key: [] if before is None else [before] for key, before in running.expected.items()
            }
            for publisher in running.publishers:
                for sent in (await why(node, publisher.topic_name)).sent:
                    assert_chain(sent, running.expected)

    asyncio.run(run())


def assert_chain(sent: Caused, expected: dict[tuple[str, int], tuple[str, int] | None]) -> None:
    """Check each step of a chain."""
    if not sent.sequence:
        return  # nothing was published to this topic
    before = expected[sent.name, sent.sequence]
    sources = [cause.source for cause in sent.causes]
    assert [(each.name, each.sequence) for each in sources if each] == (
        [] if before is None else [before]
    )
    for source in sources:
        if source is not None:
            assert_chain(source, expected)


def test_what_is_kept_is_bounded() -> None:
    """The latest entries, and the last one of each sender however old it is."""
    log = CauseLog()
    rare, often = (Party("publisher", "/robot", name, name.encode()) for name in ("/a", "/b"))
    log.note("message", rare, 1)
    for number in range(2 * MAX_KEPT):
        log.note("message", often, number)

    assert len(log.sent) == MAX_KEPT
    assert log.everything()[0].party is rare
    assert len(log.everything()) == MAX_KEPT + 1


@given(st.binary(max_size=300))
def test_what_others_send_is_not_trusted(data: bytes) -> None:
    """A question that is none asks for nothing, and an answer that is none is refused."""
    question, report = asked(data), decoded(data)

    assert encoded(answer(CauseLog(), "ab", question))
    assert report is None or encoded(report)


@given(
    st.builds(
        CauseQuestion,
        st.text(max_size=20),
        st.lists(
            st.tuples(st.sampled_from(["message", "timer"]), st.binary(), st.integers(0, 2**63)),
            max_size=3,
        ),
        st.none() | st.tuples(st.integers(-9, 2**63), st.integers(-9, 2**63)),
    )
)
def test_any_question_is_answered(question: CauseQuestion) -> None:
    """Whatever is asked for, it is read as it was sent, and the answer is bounded."""
    log = CauseLog()
    party = Party("publisher", "/robot", "/a", b"a")
    for number in range(5):
        log.note("message", party, number)

    told = decoded(encoded(answer(log, "ab", asked(encoded(question)))))

    assert asked(encoded(question)) == question
    assert told is not None
    assert len(told.sent) <= 5
