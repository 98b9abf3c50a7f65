"""A context opens with its first node and closes after its last."""

from __future__ import annotations

import asyncio
import selectors
import threading
from concurrent.futures import ThreadPoolExecutor
from typing import TYPE_CHECKING

import pytest
import uvloop

from aionode._process.concurrency import checkpoint
from aionode.engine.context import Context
from aionode.engine.transport.local import LocalTransport
from aionode.errors import EntityDestroyedError, TransportError
from aionode.interfaces.std_msgs.msg import String
from aionode.node import Node
from aionode.testing import ManualClock, local_context, settle

if TYPE_CHECKING:
    from aionode.graph import Graph


class SlowTransport(LocalTransport):
    """A transport that opens and closes only when told to, and records what it does."""

    def __init__(self) -> None:
        super().__init__()
        self.events: list[str] = []
        self.may_open = asyncio.Event()
        self.may_close = asyncio.Event()

    async def open(self, graph: Graph) -> None:
        """Wait for permission to open."""
        self.events.append("opening")
        await self.may_open.wait()
        self.events.append("open")

    async def close(self) -> None:
        """Wait for permission to close."""
        self.events.append("closing")
        await self.may_close.wait()
        self.events.append("closed")

    def hurry(self) -> None:
        """Stop waiting for permission."""
        self.may_open.set()
        self.may_close.set()


def run(tasks: asyncio.TaskGroup, node: Node) -> asyncio.Task[None]:
    """Run `node` in a task."""
    return tasks.create_task(node.run())


async def test_the_second_node_waits_until_the_first_has_opened() -> None:
    """Otherwise both would open the same connection."""
    transport = SlowTransport()
    context = Context(transport=transport)
    async with asyncio.TaskGroup() as tasks:
        nodes = [Node(name, context=context) for name in ("one", "two")]
        for node in nodes:
            run(tasks, node)
        await settle()
        assert transport.events == ["opening"]
        transport.hurry()
        await settle()
        assert all(node.is_running for node in nodes)
        context.shutdown()
    assert transport.events == ["opening", "open", "closing", "closed"]


async def test_a_node_that_comes_while_the_context_closes_opens_it_anew() -> None:
    """If it opened and closed at the same time, the connection would be left half open."""
    transport = SlowTransport()
    transport.may_open.set()
    context = Context(transport=transport)
    first, second = (Node(name, context=context) for name in ("one", "two"))
    async with asyncio.TaskGroup() as tasks:
        run(tasks, first)
        await settle()
        first.destroy_node()
        await settle()
        run(tasks, second)
        await settle()
        assert transport.events == ["opening", "open", "closing"]
        transport.hurry()
        await settle()
        assert transport.events == ["opening", "open", "closing", "closed", "opening", "open"]
        second.destroy_node()


async def test_a_shut_down_context_is_not_opened_for_nodes_that_waited() -> None:
    """Their nodes are already destroyed, and end silently."""
    transport = SlowTransport()
    context = Context(transport=transport)
    async with asyncio.TaskGroup() as tasks:
        for name in ("one", "two"):
            run(tasks, Node(name, context=context))
        await settle()
        context.shutdown()
        transport.hurry()
    assert transport.events == ["opening", "open", "closing", "closed"]
    with pytest.raises(EntityDestroyedError):
        Node("three", context=context)


async def test_a_context_that_could_not_open_can_be_tried_again() -> None:
    """The cause may be gone by then."""

    class Failing(LocalTransport):
        attempts = 0

        async def open(self, graph: Graph) -> None:
            self.attempts += 1
            if self.attempts == 1:
                raise TransportError("no way")

    node = Node("node", context=Context(transport=Failing()))
    with pytest.raises(TransportError):
        await node.run()
    async with node:
        assert node.is_running


async def test_a_context_works_in_one_loop_at_a_time() -> None:
    """Otherwise nodes of two loops would call each other's callbacks in the wrong threads."""
    context = local_context()
    other = Node("other", context=context)
    async with Node("node", context=context):
        with (
            ThreadPoolExecutor(1) as pool,
            pytest.raises(RuntimeError, match="open in another event loop"),
        ):
            pool.submit(asyncio.run, other.run()).result()
    async with other:
        assert other.is_running


def test_two_loops_that_open_a_context_at_once_are_told_at_once() -> None:
    """While the first is still connecting, one succeeds and the other gets the error at once."""
    opening, may_open = threading.Event(), threading.Event()

    class Slow(LocalTransport):
        async def open(self, graph: Graph) -> None:
            opening.set()
            while not may_open.is_set():
                await checkpoint()
            await super().open(graph)

    context = Context(transport=Slow())

    async def use(name: str) -> None:
        async with Node(name, context=context):
            pass

    with ThreadPoolExecutor(2) as pool:
        first = pool.submit(asyncio.run, use("first"))
        assert opening.wait(10)
        second = pool.submit(asyncio.run, use("second"))
        try:
            with pytest.raises(RuntimeError, match="open in another event loop"):
                second.result(10)
        finally:
            may_open.set()
        first.result(10)


async def test_a_context_does_not_wait_for_a_node_of_its_own_task() -> None:
    """The task cannot end the node while it waits for its end."""
    context = local_context()
    node = Node("node", context=context)

    with pytest.raises(RuntimeError, match="end the node first"):
        async with context:
            await node.__aenter__()

    await node.__aexit__(None, None, None)
    assert not node.is_running


async def test_a_node_may_be_ended_by_another_task_than_that_which_started_it() -> None:
    """Fixtures are entered and left by tasks of their own."""
    context = local_context()
    node = Node("node", context=context)
    async with asyncio.TaskGroup() as tasks:
        tasks.create_task(node.__aenter__())

    async with context, asyncio.TaskGroup() as tasks:
        tasks.create_task(node.__aexit__(None, None, None))


async def test_a_context_that_could_not_be_opened_is_not_in_use() -> None:
    """A second attempt may succeed, even in another loop."""

    class Failing(LocalTransport):
        fails = True

        async def open(self, graph: Graph) -> None:
            if self.fails:
                raise ConnectionError("no network")
            await super().open(graph)

    transport = Failing()
    context = Context(transport=transport)
    with pytest.raises(ConnectionError):
        async with context:
            pass
    transport.fails = False

    async def use() -> None:
        async with Node("node", context=context):
            pass

    with ThreadPoolExecutor(1) as pool:
        pool.submit(asyncio.run, use()).result(10)


def test_a_context_may_be_used_in_one_loop_after_another() -> None:
    """Programs that call `asyncio.run` several times do this."""
    context = local_context()

    async def use() -> None:
        async with Node("node", context=context):
            pass

    for _ in range(2):
        asyncio.run(use())


def test_a_loop_that_was_closed_over_a_node_does_not_hold_the_context() -> None:
    """Its node can no longer be ended properly."""
    context = local_context()
    loop = asyncio.new_event_loop()
    loop.run_until_complete(Node("left", context=context).__aenter__())
    loop.close()

    async def use() -> None:
        async with Node("node", context=context) as node:
            assert node.is_running

    asyncio.run(use())


class CountingSelector(selectors.DefaultSelector):
    """Counts how often it is polled for events, with and without waiting."""

    polls = 0
    waits = 0

    def select(self, timeout: float | None = None) -> list[tuple[selectors.SelectorKey, int]]:
        """Wait as the system's selector does."""
        if timeout is not None and timeout <= 0:
            self.polls += 1
        else:
            self.waits += 1
        return super().select(timeout)


def polls_and_waits(spin_us: float, sec: float = 0.02) -> tuple[int, int]:
    """Return how often a loop polled and how often it waited for a timer, in a context."""
    selector = CountingSelector()
    with asyncio.Runner(loop_factory=lambda: asyncio.SelectorEventLoop(selector)) as runner:

        async def main() -> tuple[int, int]:
            async with Context(transport="local", spin_us=spin_us):
                await checkpoint()
                polls, waits = selector.polls, selector.waits
                event = asyncio.Event()
                asyncio.get_running_loop().call_later(sec, event.set)
                await event.wait()
                return selector.polls - polls, selector.waits - waits

        return runner.run(main())


def test_a_loop_that_spins_asks_again_and_again_before_it_sleeps() -> None:
    """Because waking a thread takes longer than delivering the message."""
    # On a busy machine, few polls fit into a millisecond, and the process may wait for many.
    polls, waits = polls_and_waits(spin_us=1_000, sec=0.3)
    assert polls > 1
    assert waits > 0  # the rest of the time
    assert polls_and_waits(spin_us=0)[0] <= 1  # off by default


def test_a_spinning_loop_is_on_time_for_a_timer() -> None:
    """It spins only until the next timer is due."""
    polls, waits = polls_and_waits(spin_us=1e6)
    assert polls > 5
    assert waits == 0


def test_a_loop_spins_only_while_its_context_is_open() -> None:
    """A loop spins for only one context."""
    selector = selectors.DefaultSelector()

    async def main() -> None:
        async with Context(transport="local", spin_us=10):
            assert "select" in vars(selector)
            with pytest.raises(RuntimeError, match="another context of this event loop spins"):
                async with Context(transport="local", spin_us=10):
                    pass
            assert "select" in vars(selector)
        assert "select" not in vars(selector)

    with asyncio.Runner(loop_factory=lambda: asyncio.SelectorEventLoop(selector)) as runner:
        runner.run(main())


def test_a_loop_that_cannot_spin_says_so() -> None:
    """The loop of uvloop waits in C, where nothing can be inserted."""

    async def main() -> None:
        async with Context(transport="local", spin_us=10):
            pass

    with (
        asyncio.Runner(loop_factory=uvloop.new_event_loop) as runner,
        pytest.raises(RuntimeError, match=r"uvloop\.Loop cannot spin.*SelectorEventLoop"),
    ):
        runner.run(main())


def test_how_long_to_spin_is_a_number_of_microseconds() -> None:
    """An invalid value is reported when the context is created, not when it opens."""
    with pytest.raises(ValueError, match="spin_us=-1; use 0 or more microseconds"):
        Context(transport="local", spin_us=-1)
    with pytest.raises(TypeError, match="spin_us=True is not a number of microseconds"):
        Context(transport="local", spin_us=True)


async def test_contexts_with_the_same_seed_draw_the_same_ids() -> None:
    """Ids are part of what nodes publish, which must be the same in every run of a test."""
    contexts = [local_context(seed=seed) for seed in (1, 1, 2)]

    first, same, other = [(one.participant, one.new_uuid(), one.new_uuid()) for one in contexts]

    assert first == same
    assert first != other
    assert len(set(first)) == 3


def test_a_seed_is_refused_for_a_context_with_a_network() -> None:
    """Two processes with the same ids would mistake each other's messages for their own."""
    with pytest.raises(ValueError, match="seed=1 gives it ids that other contexts may have"):
        Context(seed=1)


async def test_a_manual_clock_lets_queues_take_turns_whatever_the_machine_does() -> None:
    """How many messages a callback gets per turn must not depend on the speed of the machine."""
    clock = ManualClock()
    seen: list[str] = []
    async with local_context(clock=clock) as context, Node("node", context=context) as node:
        for topic in "ab":
            node.create_subscription(String, topic, lambda msg: seen.append(msg.data), 10)
        publishers = [node.create_publisher(String, topic, 10) for topic in "ab"]
        await settle()
        for publisher in publishers:
            for _ in range(3):
                publisher.publish(String(data=publisher.topic_name))
        await settle()

    assert seen == ["/a", "/b"] * 3
