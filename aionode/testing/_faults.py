"""A transport that loses, delays, duplicates and reorders messages."""

from __future__ import annotations

import random
from functools import partial
from typing import TYPE_CHECKING, Any

from aionode.clock import MachineTime
from aionode.engine.transport.base import (
    Registration,
    Requester,
    SampleInfo,
    StopSender,
    Transport,
    Writer,
)
from aionode.message import snapshot

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Mapping

    from aionode.clock import TimeBase
    from aionode.engine.transport.base import Call, LinkStatus, Reader, ReplyTo, Serve
    from aionode.graph import EndpointInfo, Graph, NodeInfo

__all__ = ["FaultyTransport"]


class FaultyTransport(Transport):
    """Wraps a transport, and treats messages and requests like a bad network.

    To readers, messages seem to come from another process, so gaps are counted in `stats.lost`::

        Context(transport=FaultyTransport(LocalTransport(), drop=0.1, seed=1))

    Args:
        inner: The transport that carries what is not dropped.
        drop: Probability that a message or request is lost, from 0 to 1.
        delay: How long each is held back, in seconds.
        duplicate: Probability that a message is sent twice, from 0 to 1.
        reorder: Probability that a message is sent after the next one, from 0 to 1.
        seed: Seed of the random numbers; the same seed gives the same faults.
        clock: The clock that `delay` follows; the machine's by default.

    Raises:
        ValueError: a probability is not from 0 to 1, or `delay` is negative.
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
        for name, probability in (("drop", drop), ("duplicate", duplicate), ("reorder", reorder)):
            if not 0 <= probability <= 1:
                raise ValueError(f"FaultyTransport: {name}={probability}; use a number from 0 to 1")
        if delay < 0:
            raise ValueError(f"FaultyTransport: delay={delay}; use 0 or more seconds")
        self.inner = inner
        self.drop = drop
        self.delay = delay
        self.duplicate = duplicate
        self.reorder = reorder
        self._random = random.Random(seed)  # noqa: S311  # faults, not secrets
        self._time_base: TimeBase = MachineTime() if clock is None else clock

    def _strikes(self, probability: float) -> bool:
        """Return whether a fault of this probability happens now."""
        return self._random.random() < probability

    def _later(self, action: Callable[[], None]) -> None:
        """Call `action` after the delay; at once without one."""
        if self.delay == 0:
            action()
        else:
            due_ns = self._time_base.steady_ns() + round(self.delay * 1e9)
            self._time_base.call_at(due_ns, action)

    async def open(self, graph: Graph) -> None:
        """Open the inner transport."""
        await self.inner.open(graph)

    async def observe(
        self,
        what: str,
        question: bytes,
        timeout_s: float,
        participants: Collection[str] | None = None,
    ) -> dict[str, bytes | None]:
        """Ask through the inner transport."""
        return await self.inner.observe(what, question, timeout_s, participants)

    def tell(self, answers: Mapping[str, Callable[[bytes], bytes]]) -> None:
        """Answer through the inner transport."""
        self.inner.tell(answers)

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
        """Announce a publisher, whose messages are subject to the faults."""
        return _FaultyWriter(self, self.inner.create_writer(endpoint, msg_type))

    def create_reader(
        self, endpoint: EndpointInfo, msg_type: type[Any], reader: Reader
    ) -> Registration:
        """Announce a subscription; faults happen at the publisher."""
        return self.inner.create_reader(endpoint, msg_type, reader)

    def create_server(self, endpoint: EndpointInfo, srv_type: Any, serve: Serve) -> Registration:
        """Announce a server; faults happen at the client."""
        return self.inner.create_server(endpoint, srv_type, serve)

    def create_requester(self, endpoint: EndpointInfo, srv_type: Any) -> Requester:
        """Announce a client, whose requests and replies are subject to the faults."""
        return _FaultyRequester(self, self.inner.create_requester(endpoint, srv_type))


class _FaultyWriter(Writer):
    """A writer whose messages are dropped, delayed, duplicated and reordered."""

    def __init__(self, faults: FaultyTransport, inner: Writer) -> None:
        self._faults = faults
        self._inner = inner
        self._held: list[tuple[Any, int, int]] = []  # to be sent after the next message

    @property
    def active(self) -> bool:  # type: ignore[override]  # an attribute there, read-only here
        """Whether any reader would receive a message."""
        return self._inner.active

    @property
    def bounded(self) -> bool:  # type: ignore[override]  # an attribute there, read-only here
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
        """The number of messages that the inner writer has dropped, without injected losses."""
        return self._inner.dropped

    def assert_liveliness(self) -> None:
        """Assert liveliness after the delay, or drop the assertion."""
        if not self._faults._strikes(self._faults.drop):
            self._faults._later(self._inner.assert_liveliness)

    def route_of(self, reader: EndpointInfo) -> str | None:
        """Return the route of the inner writer."""
        return self._inner.route_of(reader)

    def write(self, msg: Any, sequence: int, source_ns: int) -> None:
        """Send `msg`, drop it, hold it back, or send it twice."""
        faults = self._faults
        msg = snapshot(msg)  # the caller may change it before it is sent
        released, self._held = self._held, []
        if faults._strikes(faults.reorder):
            self._held.append((msg, sequence, source_ns))
        elif not faults._strikes(faults.drop):
            copies = 2 if faults._strikes(faults.duplicate) else 1
            for _ in range(copies):
                faults._later(partial(self._inner.write, msg, sequence, source_ns))
        for held in released:
            faults._later(partial(self._inner.write, *held))

    def prepare_stop(self, stop: Any, is_last: Callable[[], bool]) -> StopSender:
        """Return the stop sender of a lease."""
        return _FaultyStop(self, self._inner.prepare_stop(stop, is_last))

    def release(self) -> None:
        """Send held messages, as nothing follows them."""
        released, self._held = self._held, []
        for held in released:
            self._faults._later(partial(self._inner.write, *held))

    def close(self) -> None:
        """Close the inner writer; held messages are lost."""
        self._held.clear()
        self._inner.close()


class _FaultyStop(StopSender):
    """The stop of a lease, which is dropped and delayed; it is the last message."""

    def __init__(self, writer: _FaultyWriter, inner: StopSender) -> None:
        self._writer = writer
        self._inner = inner

    def send(self, sequence: int, source_ns: int) -> None:
        """Send the stop after everything else, or drop it."""
        faults = self._writer._faults
        self._writer.release()
        if not faults._strikes(faults.drop):
            faults._later(partial(self._inner.send, sequence, source_ns))

    def send_past_loop(self, sequence: int, source_ns: int) -> None:
        """Send the stop without a delay, which needs the loop, or drop it."""
        faults = self._writer._faults
        if not faults._strikes(faults.drop):
            self._inner.send_past_loop(sequence, source_ns)

    def repeat(self) -> None:
        """Send the stop once more, or drop it."""
        faults = self._writer._faults
        if not faults._strikes(faults.drop):
            self._inner.repeat()


class _FaultyRequester(Requester):
    """A requester whose requests are dropped, and whose requests and replies are delayed."""

    def __init__(self, faults: FaultyTransport, inner: Requester) -> None:
        self._faults = faults
        self._inner = inner

    @property
    def servers(self) -> int:
        """The number of servers that are matched."""
        return self._inner.servers

    def send(self, request: Any, sample_info: SampleInfo, reply_to: ReplyTo) -> Call:
        """Send `request` after the delay, or drop it."""
        call = _FaultyCall(self._faults, reply_to)
        if not self._faults._strikes(self._faults.drop):
            self._faults._later(lambda: call.begin(self._inner, request, sample_info))
        return call

    def close(self) -> None:
        """Close the inner requester."""
        self._inner.close()


class _FaultyCall:
    """One request and its replies."""

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
        """Pass a response on after the delay."""
        self._faults._later(lambda: self._reply_to.reply(response, sample_info))

    def fail(self, error: Any) -> None:
        """Pass an error on after the delay."""
        self._faults._later(lambda: self._reply_to.fail(error))

    def end(self) -> None:
        """Pass the end on after the delay."""
        self._faults._later(self._reply_to.end)

    def cancel(self) -> None:
        """Cancel the request; a reply already on its way still arrives."""
        self._cancelled = True
        if self._inner is not None:
            self._inner.cancel()
