"""For tests of your nodes: no network, time that you step, and faults on demand.

With pytest the fixtures `aionode_context`, `node_factory` and `manual_clock` are there as soon as
aionode is installed (see `aionode.pytest_plugin`)::

    async def test_the_heartbeat_comes_once_a_second(node_factory, manual_clock):
        heart = node_factory("heart")
        beats = []
        heart.create_timer(1.0, lambda: beats.append(manual_clock.now()))
        await manual_clock.advance(3.0)
        assert len(beats) == 3
"""

from __future__ import annotations

import random
from typing import TYPE_CHECKING, Any

from aionode._concurrency import wait_all_tasks_blocked as settle
from aionode.clock import MachineTime
from aionode.clock import ManualTime as ManualClock
from aionode.context import Context
from aionode.message import snapshot
from aionode.transport.base import Registration, Requester, SampleInfo, Transport, Writer

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.clock import TimeBase
    from aionode.graph import EndpointInfo, Graph, NodeInfo
    from aionode.transport.base import Call, LinkStatus, Reader, ReplyTo, Serve

__all__ = ["FaultyTransport", "ManualClock", "local_context", "settle"]


def local_context(*, clock: TimeBase | None = None) -> Context:
    """Return a context without network: its nodes hear each other and nobody else.

    Args:
        clock: Where its time comes from, such as a `ManualClock`; the machine without it.
    """
    return Context(transport="local", clock=clock)


class FaultyTransport(Transport):
    """Wraps a transport and does to messages and requests what bad networks do.

    Readers behind it see what they receive as coming from another process, so gaps are counted in
    `stats.lost`::

        Context(transport=FaultyTransport(LocalTransport(), drop=0.1, seed=1))

    Args:
        inner: The transport that carries what is left.
        drop: How likely a message or request is lost, from 0 to 1.
        delay: How long each is held back, in seconds.
        duplicate: How likely a message is sent twice, from 0 to 1.
        reorder: How likely a message is sent after the next one, from 0 to 1.
        seed: Start of the random numbers; the same seed gives the same faults.
        clock: Whose time `delay` is; the machine's without it.

    Raises:
        ValueError: a likelihood is not from 0 to 1, or `delay` is negative.
    """

    def __init__(
        self,
        inner: Transport,
        *,
        drop: float = 0.0,
        delay: float = 0.0,
        duplicate: float = 0.0,
        reorder: float = 0.0,
        seed: int = 0,
        clock: TimeBase | None = None,
    ) -> None:
        for name, likelihood in (("drop", drop), ("duplicate", duplicate), ("reorder", reorder)):
            if not 0 <= likelihood <= 1:
                raise ValueError(f"FaultyTransport: {name}={likelihood}; use a number from 0 to 1")
        if delay < 0:
            raise ValueError(f"FaultyTransport: delay={delay}; use seconds from 0 up")
        self.inner = inner
        self.drop = drop
        self.delay = delay
        self.duplicate = duplicate
        self.reorder = reorder
        self._random = random.Random(seed)  # noqa: S311  # faults, not secrets
        self._time_base: TimeBase = MachineTime() if clock is None else clock

    def strikes(self, likelihood: float) -> bool:
        """Whether a fault of this likelihood happens now."""
        return self._random.random() < likelihood

    def later(self, action: Callable[[], None]) -> None:
        """Do `action` after the delay; at once without one."""
        if self.delay == 0:
            action()
        else:
            due_ns = self._time_base.steady_ns() + round(self.delay * 1e9)
            self._time_base.call_at(due_ns, action)

    async def open(self, graph: Graph) -> None:
        """Open the inner transport."""
        await self.inner.open(graph)

    async def link_status(self) -> LinkStatus:
        """Ask through the inner transport."""
        return await self.inner.link_status()

    async def close(self) -> None:
        """Close the inner transport."""
        await self.inner.close()

    def create_node(self, node: NodeInfo) -> Registration:
        """Announce a node, without faults."""
        return self.inner.create_node(node)

    def create_writer(self, endpoint: EndpointInfo, msg_type: type[Any]) -> Writer:
        """Announce a publisher, whose messages suffer."""
        return _FaultyWriter(self, self.inner.create_writer(endpoint, msg_type))

    def create_reader(
        self, endpoint: EndpointInfo, msg_type: type[Any], reader: Reader
    ) -> Registration:
        """Announce a subscription, without faults of its own."""
        return self.inner.create_reader(endpoint, msg_type, reader)

    def create_server(self, endpoint: EndpointInfo, srv_type: Any, serve: Serve) -> Registration:
        """Announce a server, without faults of its own."""
        return self.inner.create_server(endpoint, srv_type, serve)

    def create_requester(self, endpoint: EndpointInfo, srv_type: Any) -> Requester:
        """Announce a client, whose requests and replies suffer."""
        return _FaultyRequester(self, self.inner.create_requester(endpoint, srv_type))


class _FaultyWriter(Writer):
    """A writer whose messages are dropped, delayed, doubled and swapped."""

    def __init__(self, faults: FaultyTransport, inner: Writer) -> None:
        self._faults = faults
        self._inner = inner
        self._held: list[tuple[Any, SampleInfo]] = []

    @property
    def active(self) -> bool:  # type: ignore[override]  # what the inner one says
        """Whether anybody would use a message."""
        return self._inner.active

    @property
    def bounded(self) -> bool:  # type: ignore[override]  # what the inner one says
        """Whether `has_room` may be false."""
        return self._inner.bounded

    def has_room(self) -> bool:
        """Whether the inner writer has room."""
        return self._inner.has_room()

    async def drain(self) -> None:
        """Wait for the inner writer."""
        await self._inner.drain()

    @property
    def dropped(self) -> int:
        """What the inner writer has dropped; what was lost by fate, nobody counts."""
        return self._inner.dropped

    def route_of(self, reader: EndpointInfo) -> str | None:
        """Return the way of the inner writer."""
        return self._inner.route_of(reader)

    def write(self, msg: Any, sample_info: SampleInfo) -> None:
        """Let fate decide about `msg`."""
        faults = self._faults
        msg = snapshot(msg)  # the caller may change it before it is sent
        sample_info = SampleInfo(
            sample_info.gid, sample_info.sequence, sample_info.source_ns, remote=True
        )
        released, self._held = self._held, []
        if faults.strikes(faults.reorder):
            self._held.append((msg, sample_info))
        elif not faults.strikes(faults.drop):
            copies = 2 if faults.strikes(faults.duplicate) else 1
            for _ in range(copies):
                faults.later(lambda: self._inner.write(msg, sample_info))
        for held_msg, held_info in released:
            faults.later(lambda m=held_msg, o=held_info: self._inner.write(m, o))  # type: ignore[misc]  # mypy cannot infer defaults of a lambda

    def close(self) -> None:
        """Close the inner writer; what is held back is lost."""
        self._held.clear()
        self._inner.close()


class _FaultyRequester(Requester):
    """A requester whose requests are dropped, and whose requests and replies are delayed."""

    def __init__(self, faults: FaultyTransport, inner: Requester) -> None:
        self._faults = faults
        self._inner = inner

    @property
    def servers(self) -> int:
        """How many servers are matched."""
        return self._inner.servers

    def send(self, request: Any, sample_info: SampleInfo, reply_to: ReplyTo) -> Call:
        """Let fate decide about `request`."""
        call = _FaultyCall(self._faults, reply_to)
        if not self._faults.strikes(self._faults.drop):
            self._faults.later(lambda: call.begin(self._inner, request, sample_info))
        return call

    def close(self) -> None:
        """Close the inner requester."""
        self._inner.close()


class _FaultyCall:
    """One request on its way, and its replies on their way back."""

    def __init__(self, faults: FaultyTransport, reply_to: ReplyTo) -> None:
        self._faults = faults
        self._reply_to = reply_to
        self._inner: Call | None = None
        self._cancelled = False

    def begin(self, requester: Requester, request: Any, sample_info: SampleInfo) -> None:
        """Send the request, now that its delay has passed."""
        if not self._cancelled:
            self._inner = requester.send(request, sample_info, self)

    def reply(self, response: Any, sample_info: SampleInfo) -> None:
        """Pass a response on, later."""
        self._faults.later(lambda: self._reply_to.reply(response, sample_info))

    def fail(self, error: Any) -> None:
        """Pass an error on, later."""
        self._faults.later(lambda: self._reply_to.fail(error))

    def end(self) -> None:
        """Pass the end on, later."""
        self._faults.later(self._reply_to.end)

    def cancel(self) -> None:
        """Forget the request; a reply that is under way still arrives, late."""
        self._cancelled = True
        if self._inner is not None:
            self._inner.cancel()
