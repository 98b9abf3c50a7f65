"""Keeps the graph up to date: queries it when the middleware reports a change, and compares.

rcl has a guard condition that is triggered by changes, for which one thread waits. Queries run on
the loop, a few at a time, as they hold the GIL anyway.
"""

from __future__ import annotations

import hashlib
import os
import threading
from collections import Counter
from typing import TYPE_CHECKING, Any, Final

from aionode import names
from aionode._process.concurrency import SLICE_NS
from aionode.clock import perf_ns
from aionode.engine.transport.rcl._qos import profile_from
from aionode.engine.transport.rcl._types import hash_text
from aionode.errors import AionodeError, brief
from aionode.graph import SERVICE_KINDS, EndpointInfo, EndpointKind, NodeInfo
from aionode.qos import qos_profile_services_default

if TYPE_CHECKING:
    from collections.abc import Iterator

    from aionode.engine.transport.rcl._bindings import Rcl
    from aionode.engine.transport.rcl._state import RclState
    from aionode.graph import Graph

__all__ = ["RclGraphWatcher"]

UNKNOWN_NODES: Final = ("_NODE_NAME_UNKNOWN_", "_CREATED_BY_BARE_DDS_APP_")
"""Node names of endpoints whose participant has not announced its nodes."""

HIDDEN: Final = "_aionode_graph_"
"""Prefix of the names of nodes that only query the graph."""

AGAIN_S: Final = 0.1
"""Delay before the graph is queried again after an incomplete answer, in seconds."""

TRIES: Final = 20
"""Maximum number of consecutive repeated queries."""


class RclGraphWatcher:
    """Keeps the graph of the context up to date.

    Attributes:
        started_ns: When it started to watch, by `perf_ns`.
        changed_ns: When the middleware last reported a change.
        rounds: Number of complete query rounds.
    """

    def __init__(self, state: RclState) -> None:
        self._state = state
        self.started_ns = self.changed_ns = 0
        self.rounds = 0
        self._thread: threading.Thread | None = None
        self._stop: Any = None  # a guard condition
        self._stopping = False
        self._fd = -1
        self._nodes: dict[NodeInfo, None] = {}
        self._endpoints: dict[bytes, EndpointInfo] = {}
        self._steps: Iterator[None] | None = None  # of the current round
        self._stale = False  # whether it changed during the round
        self._incomplete = 0  # consecutive rounds with a part missing
        self._ids = 0

    @property
    def has_foreign(self) -> bool:
        """Whether a node of another context is known."""
        return bool(self._nodes)

    @property
    def is_complete(self) -> bool:
        """Whether the last answer was complete."""
        return not self._incomplete

    @property
    def is_settled(self) -> bool:
        """Whether no query is running or scheduled."""
        return self._steps is None and (self.is_complete or self._incomplete >= TRIES)

    def start(self, rcl: Rcl) -> None:
        """Start watching."""
        loop = self._state.loop
        if loop is None:
            return
        context = self._state.context_handle
        self.started_ns = self.changed_ns = perf_ns()
        self._stopping = False
        self._fd = os.eventfd(0, os.EFD_NONBLOCK | os.EFD_CLOEXEC)
        loop.add_reader(self._fd, self._on_change)
        with context:
            self._stop = rcl.module.GuardCondition(context)
            wait_set = rcl.module.WaitSet(0, 2, 0, 0, 0, 0, context)
        guard = rcl.graph_guard(self._state.watcher.pointer)
        self._thread = threading.Thread(
            target=self._wait, args=(rcl, wait_set, guard), name="aionode-rcl-graph", daemon=True
        )
        self._thread.start()
        os.eventfd_write(self._fd, 1)

    def stop(self) -> None:
        """Stop watching, and forget what was found; the context removes it from its graph."""
        thread, self._thread = self._thread, None
        if thread is None:
            return
        self._stopping = True
        self._stop.trigger_guard_condition()
        thread.join()
        self._stop.destroy_when_not_in_use()
        self._stop = None
        if self._state.loop is not None and not self._state.loop.is_closed():
            self._state.loop.remove_reader(self._fd)
        os.close(self._fd)
        self._fd = -1
        self._steps = None
        self._nodes.clear()
        self._endpoints.clear()

    def _wait(self, rcl: Rcl, wait_set: Any, guard: int) -> None:
        """Wait for changes, in a thread of its own."""
        with wait_set, self._stop:
            while not self._stopping:
                wait_set.clear_entities()
                rcl.add_guard(wait_set.pointer, guard, None)
                wait_set.add_guard_condition(self._stop)
                wait_set.wait(-1)  # releases the GIL
                if not self._stopping:
                    os.eventfd_write(self._fd, 1)
        wait_set.destroy_when_not_in_use()

    # On the loop

    def _on_change(self) -> None:
        try:
            os.eventfd_read(self._fd)
        except BlockingIOError:  # an earlier iteration consumed the event
            return
        self.changed_ns = perf_ns()
        self._begin()

    def _begin(self) -> None:
        if self._thread is None:
            return
        if self._steps is not None:
            self._stale = True
            return
        self._stale = False
        self._steps = self._round()
        self._go_on()

    def _go_on(self) -> None:
        """Query a part; the rest follows in the next iterations of the loop."""
        loop, steps = self._state.loop, self._steps
        if steps is None or loop is None:
            return
        ends_ns = perf_ns() + SLICE_NS
        for _ in steps:
            if perf_ns() >= ends_ns:
                loop.call_soon(self._go_on)
                return
        self._steps = None
        self.rounds += 1
        if self._stale:
            loop.call_soon(self._begin)
        elif self._incomplete and self._incomplete < TRIES:
            loop.call_later(AGAIN_S, self._begin)

    def _round(self) -> Iterator[None]:
        """Query everything, and apply the differences; each step is short."""
        state = self._state
        rcl, graph, asker = state.rcl, state.graph, state.watcher
        if rcl is None or graph is None:
            return
        nodes = self._ask_nodes(asker)
        by_name = {(node.namespace, node.name): node for node in reversed(nodes)}
        for node in nodes:
            graph.add_node(node)
        yield
        endpoints: dict[bytes, EndpointInfo] = {}
        incomplete = False
        with asker:
            topics = rcl.module.rclpy_get_topic_names_and_types(asker, False)
        for topic, types in topics:
            if not self._are_possible(topic, types):
                continue
            for kind in (EndpointKind.PUBLISHER, EndpointKind.SUBSCRIPTION):
                incomplete |= not self._ask_topic(rcl, asker, kind, topic, by_name, endpoints)
            yield
        for node in nodes:
            for kind in SERVICE_KINDS:
                incomplete |= not self._ask_services(rcl, asker, kind, node, endpoints)
            yield
        self._enter(graph, nodes, endpoints)
        self._incomplete = self._incomplete + 1 if incomplete else 0

    def _enter(
        self, graph: Graph, nodes: list[NodeInfo], endpoints: dict[bytes, EndpointInfo]
    ) -> None:
        """Apply what has changed since the last round."""
        for gid, endpoint in list(self._endpoints.items()):
            if gid not in endpoints:
                del self._endpoints[gid]
                graph.remove_endpoint(endpoint)
        for gid, endpoint in endpoints.items():
            if gid not in self._endpoints:
                self._endpoints[gid] = endpoint
                graph.add_endpoint(endpoint)
        for node in list(self._nodes):
            if node not in nodes:
                graph.remove_node(node)
        self._nodes = dict.fromkeys(nodes)

    def _ask_nodes(self, asker: Any) -> list[NodeInfo]:
        """Return the nodes of other contexts."""
        with asker:
            answer = asker.get_node_names_and_namespaces_with_enclaves()
        known = {(node.participant, node.enclave): node for node in self._nodes}
        own, seen = self._state.own_node_names(), Counter[str]()
        nodes = []
        for name, namespace, enclave in answer:
            if name.startswith(HIDDEN) or name in UNKNOWN_NODES:
                continue
            full_name = names.fully_qualified_name(namespace, name)
            if not names.is_full_node_name(name, namespace, enclave or "/"):
                self._state.note_malformed("graph", f"the name of a node, {brief(full_name)}")
                continue
            seen[full_name] += 1
            if seen[full_name] <= own[full_name]:
                continue
            # There is no id: derive one from the name, and the index among nodes with that name.
            label = f"{full_name} {seen[full_name] - own[full_name]}"
            participant = hashlib.blake2b(label.encode(), digest_size=16).hexdigest()
            node = known.get((participant, enclave))
            nodes.append(node or NodeInfo(participant, 0, name, namespace, enclave, over_rcl=True))
        return nodes

    def _are_possible(self, name: str, types: list[str]) -> bool:
        """Return whether a topic or service has a valid ROS name, and count it if not.

        Types of plain DDS programs have names of their own, which tools show.
        """
        if names.is_full_name(name) and names.is_plain(*types):
            return True
        self._state.note_malformed("graph", f"{brief(name)} of type {brief(types)}")
        return False

    def _ask_topic(
        self,
        rcl: Rcl,
        asker: Any,
        kind: EndpointKind,
        topic: str,
        nodes: dict[tuple[str, str], NodeInfo],
        endpoints: dict[bytes, EndpointInfo],
    ) -> bool:
        """Find the endpoints of a topic; return whether all of their nodes are known."""
        ask = (
            rcl.module.rclpy_get_publishers_info_by_topic
            if kind is EndpointKind.PUBLISHER
            else rcl.module.rclpy_get_subscriptions_info_by_topic
        )
        with asker:
            answer = ask(asker, topic, False)
        complete = True
        for info in answer:
            gid = bytes(info["endpoint_gid"])
            if self._state.is_own(gid):
                continue
            endpoint = self._endpoints.get(gid)
            if endpoint is None:
                node = nodes.get((info["node_namespace"], info["node_name"]))
                if node is None:
                    complete &= info["node_name"].startswith(HIDDEN)
                    continue
                endpoint = self._endpoint(kind, node, topic, info, gid)
            if endpoint is not None:
                endpoints[gid] = endpoint
        return complete

    def _endpoint(
        self, kind: EndpointKind, node: NodeInfo, topic: str, info: dict[str, Any], gid: bytes
    ) -> EndpointInfo | None:
        """Return a discovered endpoint."""
        type_hash = info["topic_type_hash"]
        try:
            qos = profile_from(info["qos_profile"])
        except (ValueError, TypeError, AionodeError) as error:
            self._state.note_malformed(topic, f"a QoS profile ({error})")
            return None
        self._ids += 1
        return EndpointInfo(
            kind=kind,
            node=node,
            endpoint_id=self._ids,
            name=topic,
            type_name=info["topic_type"],
            type_hash=hash_text(int(type_hash["version"]), bytes(type_hash["value"])),
            qos=qos,
            gid=gid,
        )

    def _ask_services(
        self,
        rcl: Rcl,
        asker: Any,
        kind: EndpointKind,
        node: NodeInfo,
        endpoints: dict[bytes, EndpointInfo],
    ) -> bool:
        """Find the servers or clients of a node; return whether it still exists.

        rcl reports no gid, hash or QoS for them: the gid is made up, the others are unknown.
        """
        ask = (
            rcl.module.rclpy_get_service_names_and_types_by_node
            if kind is EndpointKind.SERVER
            else rcl.module.rclpy_get_client_names_and_types_by_node
        )
        try:
            with asker:
                answer = ask(asker, node.name, node.namespace)
        except rcl.module.NodeNameNonExistentError:
            return False
        for name, types in answer:
            if not self._are_possible(name, types):
                continue
            for type_name in types:
                label = f"{kind.value} {node.participant} {name} {type_name}"
                gid = hashlib.blake2b(label.encode(), digest_size=16).digest()
                endpoint = self._endpoints.get(gid)
                if endpoint is None:
                    self._ids += 1
                    endpoint = EndpointInfo(
                        kind=kind,
                        node=node,
                        endpoint_id=self._ids,
                        name=name,
                        type_name=type_name,
                        type_hash="",
                        qos=qos_profile_services_default,
                        gid=gid,
                    )
                endpoints[gid] = endpoint
        return True
