"""One participant of the system: its transports, its graph, its nodes."""

from __future__ import annotations

import asyncio
import contextlib
import ctypes
import dataclasses
import os
import secrets
import threading
import weakref
from typing import TYPE_CHECKING, Any, ClassVar, Self

from aionode._concurrency import to_the_end
from aionode.arguments import Arguments, Usage
from aionode.clock import MachineTime
from aionode.endpoints._core.mismatch_report import MismatchReport
from aionode.errors import ConfigurationError, EntityDestroyedError, ForkedProcessError, brief
from aionode.graph import EndpointInfo, EndpointKind, Graph, NodeInfo
from aionode.message import type_name
from aionode.transport._zenoh_config import network_from
from aionode.transport.base import Transport
from aionode.transport.local import LocalTransport
from aionode.wire._liveliness import endpoint_token, gid_of
from aionode.wire.typehash import type_hash

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence
    from pathlib import Path
    from types import TracebackType

    from aionode.clock import TimeBase
    from aionode.node import Node
    from aionode.qos import QoSProfile

__all__ = ["Context"]

LINK_VARIABLE = "AIONODE_LINK"
LINK_SETTINGS = {"on": True, "off": False, "": True}


def wants_link(asked: bool | None, environ: Mapping[str, str]) -> bool:
    """Return whether processes of this host are to be linked, and can be.

    Raises:
        ConfigurationError: the variable says neither on nor off.
    """
    if asked is None:
        word = environ.get(LINK_VARIABLE, "")
        if word not in LINK_SETTINGS:
            raise ConfigurationError(LINK_VARIABLE, word, "on and off fit")
        asked = LINK_SETTINGS[word]
    if not asked:
        return False
    from aionode.transport.ipc import available

    return available()


class Context:
    """What the nodes of one participant share: transports, graph, domain and time.

    Nodes made without a context share `Context.default()`. A context opens with its first running
    node and closes after the last; ``async with Context() as context`` holds it open, and ends it
    with all its nodes.

    Args:
        domain_id: The ROS domain, a number from 0 up; ``ROS_DOMAIN_ID`` or 0 without it.
        transport: ``"zenoh"`` reaches other processes and ROS 2, ``"local"`` only the nodes of this
            context. A `Transport` object, or several, are used as they are.
        clock: Where the time comes from: the machine, or an `aionode.testing.ManualClock`.
        discovery_range: How far others are looked for: ``"LOCALHOST"``, ``"SUBNET"`` or ``"OFF"``;
            ``ROS_AUTOMATIC_DISCOVERY_RANGE`` without it.
        static_peers: Hosts to connect to; ``ROS_STATIC_PEERS`` without it.
        config: Path of a Zenoh configuration file in place of ``ZENOH_SESSION_CONFIG_URI``, or
            single settings by their key path.
        link: Whether other processes of this user on this host are reached through a Unix socket
            in the event loop, where the system has what it needs; ``AIONODE_LINK`` (``on`` or
            ``off``) without it, and on without that.

    Attributes:
        network: Domain, discovery and peers, from the arguments and the environment.
        graph: The nodes and endpoints known now.
        time_base: Where the time comes from.
        participant: Id of this context in the graph, in hexadecimal.

    Raises:
        ConfigurationError: an argument, or the environment variable in its place, does not fit (a
            ValueError).
        ValueError: `transport` is an unknown word.
    """

    _default: ClassVar[Context | None] = None
    _command_line: ClassVar[Usage] = Usage(Arguments())
    # For children that are forked from this process, and in them.
    _all: ClassVar[weakref.WeakSet[Context]] = weakref.WeakSet()
    _has_connected: ClassVar[bool] = False
    _parent_has_connected: ClassVar[bool] = False

    def __init__(
        self,
        *,
        domain_id: int | None = None,
        transport: str | Transport | Sequence[Transport] = "zenoh",
        clock: TimeBase | None = None,
        discovery_range: str | None = None,
        static_peers: Sequence[str] | None = None,
        config: str | Path | Mapping[str, Any] | None = None,
        link: bool | None = None,
    ) -> None:
        # Zenoh writes ids without leading zeros, and every peer has to see the same text.
        self.participant = secrets.token_hex(16).lstrip("0") or "1"
        self.graph = Graph()
        MismatchReport(self.graph, self.participant)
        self.time_base: TimeBase = clock if clock is not None else MachineTime()
        self.network = network_from(
            os.environ,
            domain_id=domain_id,
            discovery_range=discovery_range,
            static_peers=static_peers,
            config=config,
        )
        self._transports = self._make_transports(transport, link)
        self._usage: Usage | None = None  # of arguments for this context alone
        self._nodes: dict[Node, None] = {}
        self._ids = 0
        self._users = 0
        self._shut_down = False
        self._open = False
        self._loop: asyncio.AbstractEventLoop | None = None
        self._entrance = threading.Lock()
        self._turn = asyncio.Lock()  # to open or to close, one after the other
        self._closed = asyncio.Event()
        self._inherited = False
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
            # Imported here, because it is large and a context without network does not need it.
            from aionode.transport.zenoh import ZenohTransport

            zenoh = ZenohTransport(self.participant, self.network)
            if not wants_link(link, os.environ):
                return (LocalTransport(), zenoh)
            from aionode.transport.ipc import IpcTransport

            linked = IpcTransport(
                self.participant, self.network.domain_id, zenoh, zenoh.peer_directory
            )
            return (LocalTransport(), linked)
        raise ValueError(
            f'Context: transport={brief(transport)} is unknown; use "zenoh" or "local"'
        )

    # Lifetime

    @property
    def domain_id(self) -> int:
        """The ROS domain."""
        return self.network.domain_id

    @classmethod
    def default(cls) -> Context:
        """Return the context of nodes that are made without one; made at the first use.

        A forked process gets one of its own.
        """
        if cls._default is None or not cls._default.ok() or cls._default._inherited:  # noqa: SLF001
            cls._default = cls()
        return cls._default

    @classmethod
    @contextlib.contextmanager
    def as_default(cls, context: Context) -> Iterator[None]:
        """Let `context` be the default one meanwhile: nodes made without a context are in it."""
        before, cls._default = cls._default, context
        try:
            yield
        finally:
            cls._default = before

    @classmethod
    @contextlib.contextmanager
    def obeying(cls, arguments: Arguments) -> Iterator[None]:
        """Let `arguments` hold meanwhile for the nodes of every context. For `aionode.run`."""
        before, cls._command_line = cls._command_line, Usage(arguments)
        try:
            yield
        finally:
            cls._command_line = before

    @property
    def arguments(self) -> Arguments:
        """What the command line says; it holds for nodes made from now on."""
        return self.usage.arguments

    @arguments.setter
    def arguments(self, arguments: Arguments) -> None:
        self._usage = Usage(arguments)

    def ok(self) -> bool:
        """Whether the context can be used: `shutdown` was not called."""
        return not self._shut_down

    async def __aenter__(self) -> Self:
        """Open the context: connect its transports, and return when others are known."""
        self._refuse_if_shut_down()
        await self.acquire()
        return self

    async def __aexit__(
        self,
        exc_type: type[BaseException] | None,
        exc: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        """Destroy the nodes, wait for them, and close."""
        self.shutdown()
        await to_the_end(self.release())
        if self._users:
            await self._closed.wait()

    def shutdown(self) -> None:
        """Destroy all nodes, and refuse new ones. Twice is allowed.

        A node that runs ends soon after; the transports are closed when the last has.
        """
        self._shut_down = True
        for node in list(self._nodes):
            node.destroy_node()

    async def acquire(self) -> None:
        """Hold the context open: the first holder opens it. For nodes.

        Raises:
            RuntimeError: the context is open in another event loop.
            ForkedProcessError: it is the parent's, or the parent's network is (a RuntimeError).
        """
        self._refuse_if_inherited()
        with self._entrance:  # loops may be in different threads
            self._enter_loop()
            self._users += 1  # before it is open, so that another loop sees it in use
        try:
            async with self._turn:
                if not self._open and not self._shut_down:
                    await self._open_transports()
                    self._open = True
                    self._closed.clear()
        except BaseException:
            self._users -= 1
            raise

    def _enter_loop(self) -> None:
        """Note which loop the context works in: one at a time, but one after the other is fine."""
        loop = asyncio.get_running_loop()
        if self._loop is loop:
            return
        if self._loop is not None and not self._loop.is_closed() and self._users:
            raise RuntimeError(
                f"{self!r}: it is open in another event loop already; its nodes have to run in one "
                "loop, so make a context for each"
            )
        self._loop = loop
        self._turn = asyncio.Lock()
        self._closed = asyncio.Event()
        self._users = 0
        self._open = False

    async def _open_transports(self) -> None:
        opened: list[Transport] = []
        if any(not isinstance(transport, LocalTransport) for transport in self._transports):
            if Context._parent_has_connected:
                raise ForkedProcessError(repr(self))
            Context._has_connected = True
        try:
            for transport in self._transports:
                opened.append(transport)
                await transport.open(self.graph)
        except BaseException:
            for transport in reversed(opened):
                await to_the_end(transport.close())
            raise

    async def release(self) -> None:
        """Hold the context open no longer: the last holder closes it. For nodes.

        It is not to be cancelled: see `to_the_end`.
        """
        if self._inherited:
            return
        self._users -= 1
        async with self._turn:
            if self._users == 0 and self._open:  # else somebody goes on with what is open
                self._open = False
                await self._close_transports()
        if self._users == 0:
            self._closed.set()

    async def _close_transports(self) -> None:
        for transport in reversed(self._transports):
            await transport.close()
        for node in self.graph.nodes():
            if node.participant != self.participant:
                self.graph.remove_participant(node.participant)

    def _refuse_if_shut_down(self) -> None:
        if self._shut_down:
            raise EntityDestroyedError("context")

    # In forked processes

    def _refuse_if_inherited(self) -> None:
        if self._inherited:
            raise ForkedProcessError(repr(self))

    def _abandon(self) -> None:
        """Do nothing with this context any more: it belongs to the process that forked this one.

        Nothing in it may be closed, nor collected, since both would act on what the parent uses.
        """
        self._inherited = True
        for node in self._nodes:
            node.abandon()
        for transport in self._transports:
            transport.abandon()
        ctypes.pythonapi.Py_IncRef(ctypes.py_object(self))  # for ever, the interpreter's end too

    @classmethod
    def after_fork(cls) -> None:
        """Leave all contexts to the parent. Called in each forked child, before anything else."""
        for context in list(cls._all):
            context._abandon()  # noqa: SLF001  # its own class
        cls._parent_has_connected = cls._has_connected

    # What nodes need

    def add_node(self, node: Node) -> None:
        """Take `node` in.

        Raises:
            EntityDestroyedError: the context was shut down.
            ForkedProcessError: it belongs to the process that this one was forked from.
        """
        self._refuse_if_shut_down()
        self._refuse_if_inherited()
        self._nodes[node] = None

    def remove_node(self, node: Node) -> None:
        """Forget `node`."""
        self._nodes.pop(node, None)

    @property
    def usage(self) -> Usage:
        """What the nodes have made of the arguments that hold now."""
        return self._command_line if self._usage is None else self._usage

    @property
    def transports(self) -> tuple[Transport, ...]:
        """The ways that messages travel, this context itself first."""
        return self._transports

    def new_id(self) -> int:
        """Return a number that no other node or endpoint of this context has."""
        self._ids += 1
        return self._ids - 1

    def describe_node(self, name: str, namespace: str, enclave: str) -> NodeInfo:
        """Return a new node's entry in the graph."""
        return NodeInfo(self.participant, self.new_id(), name, namespace, enclave)

    def describe_endpoint(
        self, kind: EndpointKind, node: NodeInfo, name: str, ros_type: Any, qos: QoSProfile
    ) -> EndpointInfo:
        """Return a new endpoint's entry in the graph."""
        endpoint = EndpointInfo(
            kind=kind,
            node=node,
            endpoint_id=self.new_id(),
            name=name,
            type_name=type_name(ros_type),
            type_hash=type_hash(ros_type),
            qos=qos,
            gid=b"",
        )
        gid = gid_of(endpoint_token(self.network.domain_id, endpoint))
        return dataclasses.replace(endpoint, gid=gid)


if hasattr(os, "register_at_fork"):  # Windows does not fork
    os.register_at_fork(after_in_child=Context.after_fork)
