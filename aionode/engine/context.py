"""The context shared by nodes: one participant in the ROS graph, with its transports.

A peer that ends is removed from the graph in `engine/transport/zenoh/discovery/graph_watcher.py`,
and its links in `engine/transport/link/_manager.py`, which also reconnects. How often Zenoh
reconnects, and when it gives up on a silent peer: `engine/transport/zenoh/session/settings.py`.
"""

from __future__ import annotations

import asyncio
import contextlib
import ctypes
import itertools
import math
import os
import threading
import uuid
import weakref
from collections import Counter
from typing import TYPE_CHECKING, Any, ClassVar, Protocol, Self

from aionode._distribution import choose_distribution
from aionode._process.concurrency import running_loop, spin_before_blocking, to_the_end
from aionode._process.imports import uncollected
from aionode._process.sudden_end import SENDS
from aionode.arguments import Arguments, Usage
from aionode.clock import MachineTime, perf_ns
from aionode.engine.causes import CauseLog
from aionode.engine.loop_affinity import LoopAffinity
from aionode.engine.reports.duplicates import DuplicateReport
from aionode.engine.reports.mismatches import MismatchReport
from aionode.engine.transport.base import Transport
from aionode.engine.transport.drops import Drops
from aionode.engine.transport.local import LocalTransport
from aionode.engine.transport.network import network_from, new_participant, unheard_middleware
from aionode.engine.wire._replaced_texts import REPLACED_TEXTS
from aionode.errors import ConfigurationError, EntityDestroyedError, ForkedProcessError, brief
from aionode.graph import Graph
from aionode.logging import get_logger

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping, Sequence
    from pathlib import Path
    from random import Random
    from types import TracebackType

    from aionode.clock import TimeBase
    from aionode.engine.observation import NodeReport, ProcessReport

__all__ = ["Context", "obeying", "openings"]

TRANSPORT_VARIABLE = "AIONODE_TRANSPORT"

LINK_VARIABLE = "AIONODE_LINK"
LINK_SETTINGS = {"on": True, "off": False, "": True}

CAUSES_VARIABLE = "AIONODE_CAUSES"
CAUSES_SETTINGS = {"1": True, "0": False, "": False}


def transport_of(environ: Mapping[str, str]) -> str:
    """Return the transport selected by the environment; zenoh by default.

    Raises:
        ConfigurationError: the value is not a known transport.
    """
    word = environ.get(TRANSPORT_VARIABLE, "") or "zenoh"
    if word not in {"zenoh", "rcl", "local"}:
        raise ConfigurationError(TRANSPORT_VARIABLE, word, "use zenoh, rcl or local")
    return word


def wants_link(asked: bool | None, environ: Mapping[str, str]) -> bool:
    """Return whether to use the link transport for processes on this host.

    Raises:
        ConfigurationError: the environment variable is neither on nor off.
    """
    if asked is None:
        word = environ.get(LINK_VARIABLE, "")
        if word not in LINK_SETTINGS:
            raise ConfigurationError(LINK_VARIABLE, word, "use on or off")
        asked = LINK_SETTINGS[word]
    if not asked:
        return False
    from aionode.engine.transport.link import available

    return available()


def wants_causes(asked: bool | None, environ: Mapping[str, str]) -> bool:
    """Return whether to keep what caused each message.

    Raises:
        ConfigurationError: the environment variable is neither 1 nor 0.
    """
    if asked is not None:
        return asked
    word = environ.get(CAUSES_VARIABLE, "")
    if word not in CAUSES_SETTINGS:
        raise ConfigurationError(CAUSES_VARIABLE, word, "use 1 or 0")
    return CAUSES_SETTINGS[word]


class ContextNode(Protocol):
    """The part of a node that its context uses; a protocol, as `Node` imports the context."""

    def destroy_node(self) -> None:
        """End the node."""


class Context:
    """The transports, graph, domain and time shared by the nodes of one participant.

    Nodes created without a context share `Context.default()`. A context opens with its first
    running node and closes after the last one; ``async with Context() as context`` keeps it open
    for the whole block, and destroys all its nodes at the end.

    Args:
        domain_id: The ROS domain, 0 or more; defaults to ``ROS_DOMAIN_ID``, or 0.
        transport: ``"zenoh"`` reaches other processes, including ROS 2 on rmw_zenoh; ``"rcl"``
            reaches ROS 2 over the middleware of the installed ROS 2, such as DDS; ``"local"``
            reaches only the nodes of this context. `Transport` objects, one or several, are used as
            they are. Defaults to ``AIONODE_TRANSPORT``, or ``"zenoh"``.
        clock: The source of time: the machine, or an `aionode.testing.ManualClock`.
        discovery_range: Where to look for other processes: ``"LOCALHOST"``, ``"SUBNET"`` or
        ``"OFF"``; defaults to ``ROS_AUTOMATIC_DISCOVERY_RANGE``.
        static_peers: Hosts to connect to; defaults to ``ROS_STATIC_PEERS``.
        config: Path of a Zenoh configuration file, overriding ``ZENOH_SESSION_CONFIG_URI``, or
            individual settings by key path.
        link: Whether to reach other processes of this user on this host over a Unix socket served
            by the event loop, where the platform supports it; defaults to ``AIONODE_LINK`` (``on``
            or
        ``off``), or on.
        spin_us: How long the event loop polls for events before it lets its thread sleep, in
            microseconds. That avoids wake-up latency, but takes a whole core while messages arrive
            at shorter intervals. Only for asyncio's own event loop, and one context per loop.
        ros_distro: The distribution of the ROS 2 nodes to communicate with, such as ``"humble"``;
            defaults to ``ROS_DISTRO``, or ``"jazzy"``. Nodes of Humble and of newer distributions
            cannot communicate, so a context supports one or the other.
        queue_bytes: How many bytes of messages may wait in each queue to and from other processes:
            of a subscription whose loop or callback is busy, of a service, and of a publisher with
            slow readers. Beyond that, messages are dropped and counted, or refused by KEEP_ALL and
            services. Defaults to ``AIONODE_QUEUE_BYTES``, or 32 MiB; a single message is never too
            large.
        graph_bytes: How many bytes of other processes' announcements to keep, mainly of nodes and
            endpoints, which count about 2.2 kB each. A single process may use an eighth of that.
            Beyond that, announcements are ignored with a warning. Defaults to
            ``AIONODE_GRAPH_BYTES``, or 64 MiB, about 30,000 endpoints.
        seed: For tests without a network: a seed for the ids of the context, its endpoints and its
            goals, which makes them the same in every run. Callbacks that block the loop are not
            reported then, as this depends on the machine. By default ids are unique.
        causes: Whether to keep what caused each message, for ``aionode why`` and `observe.why`;
            defaults to ``AIONODE_CAUSES`` (``1`` or ``0``), or off, as it makes messages more
            expensive.

    Attributes:
        ros_distro: The distribution of ROS 2 that it belongs to.
        network: Domain, discovery and peers, from the arguments and the environment.
        graph: The currently known nodes and endpoints.
        drops: What rclpy programs drop of what others send; `dropped` includes everything.
        time_base: The source of time.
        participant: The id of this context in the graph, in hexadecimal.
        seed: The seed of its ids; None if they are unique.
        causes: What caused the latest messages; None if that is not kept.

    Raises:
        ConfigurationError: an argument, or the environment variable used instead, is invalid (a
            ValueError).
        TypeError: `spin_us` is not a number.
        ValueError: `transport` is unknown, `spin_us` is negative, or `seed` is combined with a
            network.
    """

    _openings: ClassVar[int] = 0
    _default: ClassVar[Context | None] = None
    _command_line: ClassVar[Usage] = Usage(Arguments())
    # For forked children: all contexts of this process, and whether one of them, or one of the
    # parent's, has ever opened a connection, which a fork breaks.
    _all: ClassVar[weakref.WeakSet[Context]] = weakref.WeakSet()
    _has_connected: ClassVar[bool] = False
    _parent_has_connected: ClassVar[bool] = False

    def __init__(
        self,
        *,
        domain_id: int | None = None,
        transport: str | Transport | Sequence[Transport] | None = None,
        clock: TimeBase | None = None,
        discovery_range: str | None = None,
        static_peers: Sequence[str] | None = None,
        config: str | Path | Mapping[str, Any] | None = None,
        link: bool | None = None,
        spin_us: float = 0,
        ros_distro: str | None = None,
        queue_bytes: int | None = None,
        graph_bytes: int | None = None,
        seed: int | None = None,
        causes: bool | None = None,
    ) -> None:
        if isinstance(spin_us, bool) or not isinstance(spin_us, int | float):
            raise TypeError(f"Context: spin_us={brief(spin_us)} is not a number of microseconds")
        if not 0 <= spin_us < math.inf:
            raise ValueError(f"Context: spin_us={spin_us}; use 0 or more microseconds")
        self._spin_ns = int(spin_us * 1e3)
        self._stop_spinning: Callable[[], None] | None = None
        self.ros_distro = choose_distribution(os.environ, ros_distro)
        self.seed = seed
        self._random: Random | None = None
        if seed is not None:
            from random import Random  # few contexts have a seed

            self._random = Random(seed)  # noqa: S311  # ids, not secrets
        self.participant = (
            new_participant() if self._random is None else f"f{self._random.getrandbits(124):031x}"
        )
        self.graph = Graph(self.participant)
        self.drops = Drops()
        self.causes = CauseLog() if wants_causes(causes, os.environ) else None
        self._replaced_before = REPLACED_TEXTS.total()
        MismatchReport(self.graph, self.participant)
        DuplicateReport(self.graph, self.participant)
        self.time_base: TimeBase = clock if clock is not None else MachineTime()
        self.network = network_from(
            os.environ,
            domain_id=domain_id,
            discovery_range=discovery_range,
            static_peers=static_peers,
            config=config,
            queue_bytes=queue_bytes,
            graph_bytes=graph_bytes,
        )
        if transport is None:
            transport = transport_of(os.environ)
        self._is_on_zenoh = transport == "zenoh"
        self._transports = self._make_transports(transport, link)
        if seed is not None and transport in {"zenoh", "rcl"}:
            raise ValueError(
                f"Context: seed={seed} gives it ids that other contexts may have, which a network "
                'does not allow; use transport="local", or leave out the seed'
            )
        self._usage: Usage | None = None  # of arguments set for this context only
        # From construction to destruction, each with what to call in a forked child.
        self._nodes: dict[ContextNode, Callable[[], None]] = {}
        self._ids = itertools.count()  # of its nodes and endpoints
        # The tasks of running nodes and `async with` blocks, with how many of these each has, the
        # longest known first; without any, the transports close.
        self._users: dict[asyncio.Task[Any] | None, int] = {}
        self._shut_down = False  # set by `shutdown`, and never reset
        self._reporters: dict[object, Callable[[], NodeReport]] = {}
        self._open = False  # whether the transports are open
        self._loop: asyncio.AbstractEventLoop | None = None  # the loop in which it was last opened
        self._affinity = LoopAffinity()  # the same while in use, for calls from other threads
        self._loop_guard = threading.Lock()  # held to check and set `_loop` and `_users`
        self._transition = asyncio.Lock()  # held while the transports open or close
        self._closed = asyncio.Event()  # set when the last user has released the context
        self._inherited = False  # whether it belongs to the parent of this forked process
        Context._all.add(self)

    def __repr__(self) -> str:
        state = "shut down" if self._shut_down else "open" if self._users else "closed"
        return f"<Context domain={self.network.domain_id} {state} nodes={len(self._nodes)}>"

    def _make_transports(
        self, transport: str | Transport | Sequence[Transport], link: bool | None
    ) -> tuple[Transport, ...]:
        if isinstance(transport, Transport):
            return (transport,)
        if not isinstance(transport, str):
            return tuple(transport)
        if transport == "local":
            return (LocalTransport(),)
        if transport == "zenoh":
            # Imported on demand: it is large, and a local context does not need it.
            with uncollected():
                from aionode.engine.transport.zenoh import ZenohTransport
                from aionode.engine.transport.zenoh.bridge import BridgeTransport

            zenoh = ZenohTransport(self.participant, self.network, self.time_base)
            bridges = BridgeTransport(zenoh.session_state, self.time_base)
            if not wants_link(link, os.environ):
                return (LocalTransport(), zenoh, bridges)
            with uncollected():
                from aionode.engine.transport.link import LinkTransport

            linked = LinkTransport(
                self.participant,
                self.network.domain_id,
                zenoh,
                zenoh.peer_directory,
                self.time_base,
            )
            return (LocalTransport(), linked, bridges)
        if transport == "rcl":
            from aionode.engine.transport.rcl import RclTransport

            return (LocalTransport(), RclTransport(self.participant, self.network))
        raise ValueError(
            f'Context: transport={brief(transport)} is unknown; use "zenoh", "rcl" or "local"'
        )

    # Lifetime

    @property
    def domain_id(self) -> int:
        """The ROS domain."""
        return self.network.domain_id

    @classmethod
    def default(cls) -> Context:
        """Return the context of nodes created without one, creating it on first use.

        A forked process gets its own.
        """
        if cls._default is None or not cls._default.ok() or cls._default._inherited:
            cls._default = cls()
        return cls._default

    @classmethod
    @contextlib.contextmanager
    def as_default(cls, context: Context) -> Iterator[None]:
        """Make `context` the default for nodes created in the ``with`` block."""
        before, cls._default = cls._default, context
        try:
            yield
        finally:
            cls._default = before

    @property
    def arguments(self) -> Arguments:
        """The ROS arguments that apply to nodes created from now on."""
        return self._current_usage.arguments

    @arguments.setter
    def arguments(self, arguments: Arguments) -> None:
        self._usage = Usage(arguments)

    def new_uuid(self) -> bytes:
        """Return the 16 bytes of a random UUID, drawn from the seed if there is one."""
        if self._random is None:
            return uuid.uuid4().bytes
        return uuid.UUID(int=self._random.getrandbits(128), version=4).bytes

    def ok(self) -> bool:
        """Whether the context is usable, i.e. `shutdown` was not called."""
        return not self._shut_down

    async def __aenter__(self) -> Self:
        """Open the context: connect its transports, and wait for initial discovery.

        Raises:
            EntityDestroyedError: the context was shut down (a RuntimeError).
            RuntimeError: the context is open in another event loop, or cannot spin in this one.
            ForkedProcessError: it is the parent's, or the parent was connected (a RuntimeError).
            TransportError: a transport cannot connect.
        """
        self._refuse_if_shut_down()
        await self._acquire()
        return self

    async def __aexit__(
        self,
        exc_type: type[BaseException] | None,
        exc: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        """Destroy the nodes, wait until they have ended, and close the transports.

        Raises:
            RuntimeError: this task has started a node that it has not ended, and would wait for
                itself.
        """
        self.shutdown()
        task = asyncio.current_task()
        await to_the_end(self._release(task), exc)
        if task in self._users:
            raise RuntimeError(
                f"{self!r}: the `async with` of the context ends before that of a node which the "
                "same task has started, and would wait for it forever; end the node first"
            )
        if self._users:
            await self._closed.wait()

    def shutdown(self) -> None:
        """Destroy all nodes, and refuse new ones. Repeating it has no effect.

        Running nodes end soon after; the transports close once the last of them has ended.
        """
        self._shut_down = True
        for node in list(self._nodes):
            node.destroy_node()
        if not self._users:
            self.graph.close()

    async def _acquire(self) -> None:
        """Keep the context open until `_release`; the first user opens the transports.

        Raises:
            RuntimeError: the context is open in another event loop.
            ForkedProcessError: it is the parent's, or the parent was connected (a RuntimeError).
        """
        self._refuse_if_inherited()
        with self._loop_guard:  # event loops may run in different threads
            self._bind_to_loop()
            # Before opening, so that another loop sees it in use.
            task = asyncio.current_task()
            self._users[task] = self._users.get(task, 0) + 1
            self._affinity.attach()
        try:
            async with self._transition:
                if not self._open and not self._shut_down:
                    await self._open_transports()
                    self._open = True
                    self._closed.clear()
        except BaseException:
            self._forget(task)
            if not self._users:
                self._affinity.detach()
            raise

    def _forget(self, task: asyncio.Task[Any] | None) -> None:
        """Take one node or block of a task off its count."""
        if self._users[task] > 1:
            self._users[task] -= 1
        else:
            del self._users[task]

    def _bind_to_loop(self) -> None:
        """Bind the context to the running loop; a context works in one loop at a time."""
        loop = running_loop()
        if self._loop is loop:
            return
        if self._loop is not None and not self._loop.is_closed() and self._users:
            raise RuntimeError(
                f"{self!r}: already open in another event loop; all nodes of a context must run in "
                "one loop, so create one context for each loop"
            )
        self._loop = loop
        self._transition = asyncio.Lock()
        self._closed = asyncio.Event()
        self._users = {}
        self._open = False

    async def _open_transports(self) -> None:
        opened: list[Transport] = []
        Context._openings += 1
        if any(not isinstance(transport, LocalTransport) for transport in self._transports):
            if Context._parent_has_connected:
                raise ForkedProcessError(repr(self))
            Context._has_connected = True
        if self._spin_ns:
            loop = running_loop()
            self._stop_spinning = spin_before_blocking(loop, self._spin_ns, perf_ns, repr(self))
        try:
            for transport in self._transports:
                opened.append(transport)
                transport.tell({"report": self._encoded_report, "causes": self._encoded_causes})
                await transport.open(self.graph)
            self._hint_at_rcl()
        except BaseException:
            for transport in reversed(opened):
                await to_the_end(transport.close())
            self._end_spinning()
            raise

    def _hint_at_rcl(self) -> None:
        """Log how to reach the other ROS 2 nodes of this environment, if none is heard."""
        if not self._is_on_zenoh:
            return
        hint = unheard_middleware(os.environ)
        if hint and all(node.participant == self.participant for node in self.graph.nodes()):
            get_logger("aionode.context").warning(hint)

    def _end_spinning(self) -> None:
        stop, self._stop_spinning = self._stop_spinning, None
        if stop is not None:
            stop()

    async def _release(self, task: asyncio.Task[Any] | None) -> None:
        """Undo one `_acquire`; the last user closes the transports.

        Must not be cancelled half-way: call it through `to_the_end`.

        Args:
            task: The task that calls this; another task may have called `_acquire`.
        """
        if self._inherited:
            return
        self._forget(task if task in self._users else next(iter(self._users)))
        async with self._transition:
            if not self._users and self._open:  # unless it was acquired again in the meantime
                self._open = False
                await self._close_transports()
        if not self._users:
            self._affinity.detach()
            self._closed.set()
            if self._shut_down:
                self.graph.close()

    async def _close_transports(self) -> None:
        self._end_spinning()
        for transport in reversed(self._transports):
            await transport.close()
        for participant in {node.participant for node in self.graph.nodes()} - {self.participant}:
            self.graph.remove_participant(participant)

    @classmethod
    def _send_rest(cls, ends_ns: int) -> bool:
        """Pass published messages to the operating system, until `ends_ns` at the latest.

        The event loops of other threads keep running, and send their own.

        Returns:
            Whether there is a network, whose threads need a moment longer.
        """
        is_connected = False
        for context in list(cls._all):
            if not context._open or context._inherited:
                continue
            for transport in context._transports:
                if context._affinity.thread == threading.get_ident():
                    transport.send_rest(ends_ns)
                is_connected |= not isinstance(transport, LocalTransport)
        return is_connected

    def _refuse_if_shut_down(self) -> None:
        if self._shut_down:
            raise EntityDestroyedError("context")

    # In forked processes

    def _refuse_if_inherited(self) -> None:
        if self._inherited:
            raise ForkedProcessError(repr(self))

    def _abandon(self) -> None:
        """Leave this context to the parent process from which this one was forked.

        Nothing in it may be closed or garbage-collected, as both would affect the parent.
        """
        self._inherited = True
        self._affinity.detach()
        for abandon in self._nodes.values():
            abandon()
        for transport in self._transports:
            transport.abandon()
        ctypes.pythonapi.Py_IncRef(ctypes.py_object(self))  # never collected, not even at exit

    @classmethod
    def _after_fork(cls) -> None:
        """Leave all contexts to the parent; called in a forked child before anything else runs."""
        for context in list(cls._all):
            context._abandon()
        cls._parent_has_connected = cls._has_connected

    # For tools

    def report(self) -> ProcessReport:
        """Return the report of this context for tools: its nodes, endpoints and callbacks."""
        from aionode.engine.observation import process_report  # nobody may ever ask

        return process_report(self.participant, self.dropped, list(self._reporters.values()))

    def _encoded_report(self, _: bytes) -> bytes:
        from aionode.engine.observation import encoded  # as above

        return encoded(self.report())

    def _encoded_causes(self, question: bytes) -> bytes:
        from aionode.engine.cause_reports import answer, asked, encoded  # as above

        return encoded(answer(self.causes, self.participant, asked(question)))

    # For nodes

    def add_reporter(self, node: object, report: Callable[[], NodeReport]) -> Callable[[], None]:
        """Include a node in the reports of this context; return a function that removes it."""
        self._reporters[node] = report

        def end() -> None:
            self._reporters.pop(node, None)

        return end

    @property
    def _current_usage(self) -> Usage:
        """Records which of the current arguments the nodes have used."""
        return self._command_line if self._usage is None else self._usage

    @property
    def dropped(self) -> Mapping[str, int]:
        """The number of things from other processes that were dropped or refused, by reason.

        For example ``malformed``; the log describes them. Messages dropped by the QoS of a
        subscription are in its `stats`. ``replaced_texts`` counts messages of the whole process
        that were not dropped: they contain invalid Unicode, which was decoded with U+FFFD.
        """
        drops = {
            id(drops): drops for drops in (self.drops, *(each.drops for each in self._transports))
        }
        replaced = Counter(replaced_texts=REPLACED_TEXTS.total() - self._replaced_before)
        return +sum((each.totals() for each in drops.values()), replaced)

    @property
    def transports(self) -> tuple[Transport, ...]:
        """The transports in the order in which they open; the local one is first."""
        return self._transports


@contextlib.contextmanager
def obeying(arguments: Arguments) -> Iterator[None]:
    """Apply `arguments` to the nodes of every context within the ``with`` block."""
    before, Context._command_line = Context._command_line, Usage(arguments)
    try:
        yield
    finally:
        Context._command_line = before


def openings() -> int:
    """Return how often contexts of this process have opened, for running or past nodes."""
    return Context._openings


SENDS.append(Context._send_rest)
if hasattr(os, "register_at_fork"):  # not on Windows
    os.register_at_fork(after_in_child=Context._after_fork)
