"""The graph behind bridges, built from their liveliness tokens."""

from __future__ import annotations

import asyncio
import logging
from contextlib import suppress
from functools import partial
from typing import TYPE_CHECKING, Any, Final, TypeAlias

import zenoh

from aionode._process.concurrency import running_loop
from aionode.engine.transport.zenoh.connections.handlers import direct, translated
from aionode.engine.wire._bridge import (
    BRIDGES,
    BridgedNode,
    BridgeToken,
    bridged_endpoints,
    config_key,
    namespace_prefix,
    node_keys,
    parse_bridge_token,
    parse_node,
)
from aionode.engine.wire._liveliness import gid_of
from aionode.graph import EndpointInfo, EndpointKind, NodeInfo

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from aionode.engine.transport.zenoh._session_state import SessionState
    from aionode.engine.transport.zenoh.bridge._state import BridgeState
    from aionode.engine.wire._bridge import BridgedEndpoint
    from aionode.graph import Graph

__all__ = ["BridgeWatcher"]

logger = logging.getLogger("aionode.transport.zenoh")

ANSWER_S: Final = 2.0
"""Timeout for a bridge's answer, in seconds; it takes a millisecond, but in the bridge's main
task."""

AGAIN_S: Final = (0.05, 0.1, 0.2, 0.5, 1.0, 1.0, 1.0, 1.0)
"""Delays before asking a bridge again that did not answer, in seconds: it announces itself before
it has joined DDS, and answers only after that."""

NODE_NAME: Final = "zenoh_bridge_ros2dds"
"""The name of a bridge's own node on DDS, which stands in for unknown nodes."""

NODE_SERVICES: Final = frozenset(
    {
        "describe_parameters",
        "get_parameter_types",
        "get_parameters",
        "list_parameters",
        "set_parameters",
        "set_parameters_atomically",
        "get_type_description",
    }
)
"""Services whose names reveal the node that has them."""

NODE_PACKAGES: Final = ("rcl_interfaces/srv/", "type_description_interfaces/srv/")


Replies: TypeAlias = list[tuple[str, bytes]]
"""The keys and payloads of the replies to a query."""


class Bridge:
    """One bridge, and the part of the graph that it has announced.

    Attributes:
        prefix: The prefix of its keys.
        node: Its own node.
        nodes: The nodes behind it, if it was queried.
        endpoints: The endpoints in the graph, by token.
    """

    def __init__(self, prefix: str, node: NodeInfo) -> None:
        self.prefix = prefix
        self.node = node
        self.nodes: list[BridgedNode] = []
        self.endpoints: dict[str, list[EndpointInfo]] = {}


class BridgeWatcher:
    """Keeps the graph up to date with what bridges announce.

    Args:
        session_state: The session state of the context.
        bridges: The connection to bridges, which starts with the first one.
    """

    def __init__(self, session_state: SessionState, bridges: BridgeState) -> None:
        self._state = bridges
        self._announced = session_state.announced
        self._queue_of = session_state.queue
        self._queue = session_state.queue(self._take)
        self._session: zenoh.Session | None = None
        self._graph: Graph | None = None
        self._subscriber: zenoh.Subscriber[None] | None = None
        self._tokens: dict[str, dict[str, BridgeToken]] = {}
        self._bridges: dict[str, Bridge] = {}
        # Bridges whose key prefix is not known yet.
        self._asked: dict[str, asyncio.Future[None]] = {}
        # Number of endpoints per node; a node without any is forgotten.
        self._users: dict[NodeInfo, int] = {}
        self._next_id = 0

    async def start(self, session: zenoh.Session, graph: Graph) -> None:
        """Subscribe to the tokens, and wait until existing ones are known."""
        self._session, self._graph = session, graph
        with translated("bridges"):
            self._subscriber = session.liveliness().declare_subscriber(
                f"{BRIDGES}/**", direct(self._queue.put), history=True
            )
        # Only its end matters: the subscriber gets the same tokens.
        await self._replies(session.liveliness().get, f"{BRIDGES}/**")
        await self.settled()

    def stop(self) -> None:
        """Unsubscribe, and forget all bridges."""
        subscriber, self._subscriber = self._subscriber, None
        if subscriber is not None:
            subscriber.undeclare()
        self._queue.clear()
        for asked in self._asked.values():
            asked.cancel()
        self._asked.clear()
        for zid in list(self._bridges):
            self._remove_bridge(zid)
        self._tokens.clear()
        self._session = self._graph = None

    async def settled(self) -> None:
        """Wait until each bridge has answered, or failed to do so in time."""
        if self._asked:
            await asyncio.wait(list(self._asked.values()))

    # Tokens

    def _take(self, sample: zenoh.Sample) -> None:
        key = str(sample.key_expr)
        token = parse_bridge_token(key)
        if token is None or token.zid == self._state.participant:
            return
        if sample.kind == zenoh.SampleKind.PUT:
            self._add(key, token)
        else:
            self._remove(key, token)

    def _add(self, key: str, token: BridgeToken) -> None:
        tokens = self._tokens.setdefault(token.zid, {})
        if key in tokens or not self._announced.admit(token.zid, key):
            if not tokens:
                del self._tokens[token.zid]
            return
        tokens[key] = token
        if not token.kind:
            self._ask(token.zid)
        elif token.zid in self._bridges:
            self._show(self._bridges[token.zid], key, token)
            self._note_vendor(token.zid)

    def _remove(self, key: str, token: BridgeToken) -> None:
        tokens = self._tokens.get(token.zid, {})
        if tokens.pop(key, None) is None:
            return
        self._announced.release(token.zid, key)
        if not tokens:
            del self._tokens[token.zid]
        if not token.kind:
            asked = self._asked.pop(token.zid, None)
            if asked is not None:
                asked.cancel()
            self._remove_bridge(token.zid)
        elif token.zid in self._bridges:
            self._hide(self._bridges[token.zid], key)
            self._note_vendor(token.zid)

    # Bridges

    def _ask(self, zid: str) -> None:
        """Ask a new bridge for its key prefix; until then it is not in the graph."""
        if self._session is not None and zid not in self._asked:
            asked = self._asked[zid] = running_loop().create_future()
            self._ask_again(zid, asked, iter(AGAIN_S))

    def _ask_again(self, zid: str, asked: asyncio.Future[None], delays_s: Iterator[float]) -> None:
        if self._session is not None and not asked.done():
            then = partial(self._meet, zid, asked, delays_s)
            self._query(self._session.get, config_key(zid), then)

    def _meet(
        self, zid: str, asked: asyncio.Future[None], delays_s: Iterator[float], replies: Replies
    ) -> None:
        """Show a bridge once it has answered, or timed out, unless it has gone meanwhile."""
        session, graph = self._session, self._graph
        if asked.done() or session is None or graph is None:
            return
        delay_s = None if replies else next(delays_s, None)
        if delay_s is not None:
            loop = running_loop()
            loop.call_later(delay_s, self._ask_again, zid, asked, delays_s)
            return
        import json  # nodes that meet no bridge need none

        namespace, name = "/", NODE_NAME
        for _, payload in replies:
            with suppress(ValueError, AttributeError):
                config = json.loads(payload)
                namespace = str(config.get("namespace") or namespace)
                name = str(config.get("nodename") or name)
        del self._asked[zid]
        asked.set_result(None)
        prefix = namespace_prefix(namespace)
        node = self._node(zid, f"/{prefix}{name}")
        bridge = self._bridges[zid] = Bridge(prefix, node)
        self._use(node)
        if self._state.session is None:
            self._state.connect(session, graph)
            self._state.graph_is_known()
        for key, token in list(self._tokens.get(zid, {}).items()):
            if token.kind:
                self._show(bridge, key, token)
        self._note_vendor(zid)
        self._state.add_bridge(zid, prefix)
        logger.debug("zenoh-bridge-ros2dds %s: its nodes on DDS are reached from now on", zid)

    def _remove_bridge(self, zid: str) -> None:
        bridge = self._bridges.pop(zid, None)
        if bridge is None:
            return
        for key in list(bridge.endpoints):
            self._hide(bridge, key)
        self._unuse(bridge.node)
        self._state.remove_bridge(zid)

    def _note_vendor(self, zid: str) -> None:
        """Record whether there are nodes on Fast DDS, which does not transmit the history QoS."""
        tokens = self._tokens.get(zid, {}).values()
        nodes = self._bridges[zid].nodes
        if any(not token.has_history for token in tokens) or any(n.uses_fast_dds for n in nodes):
            self._state.fast_dds.add(zid)
        else:
            self._state.fast_dds.discard(zid)

    async def ask_for_nodes(self) -> None:
        """Ask each bridge for its nodes, and assign endpoints to them. For tools."""
        await self.settled()
        session = self._session
        for zid, bridge in list(self._bridges.items()):
            if session is None:
                return
            replies = await self._replies(session.get, node_keys(zid))
            nodes = [node for reply in replies if (node := parse_node(*reply)) is not None]
            if self._bridges.get(zid) is not bridge or not nodes:
                continue
            bridge.nodes = nodes
            for key, token in list(self._tokens.get(zid, {}).items()):
                if token.kind:
                    self._hide(bridge, key)
                    self._show(bridge, key, token)
            self._note_vendor(zid)

    async def _replies(self, get: Callable[..., Any], key: str) -> Replies:
        """Return the replies to a query."""
        done: asyncio.Future[Replies] = running_loop().create_future()

        def answer(replies: Replies) -> None:
            if not done.done():
                done.set_result(replies)

        self._query(get, key, answer)
        return await done

    def _query(self, get: Callable[..., Any], key: str, then: Callable[[Replies], object]) -> None:
        """Call `then` soon after all replies to a query have arrived."""
        replies: Replies = []

        def take(reply: zenoh.Reply | None) -> None:
            if reply is None:
                then(replies)
            elif reply.ok is not None:
                replies.append((str(reply.ok.key_expr), reply.ok.payload.to_bytes()))

        queue = self._queue_of(take)
        with translated(key):
            get(key, direct(queue.put, lambda: queue.put(None)), timeout=ANSWER_S)

    # The graph

    def _show(self, bridge: Bridge, key: str, token: BridgeToken) -> None:
        if self._graph is None or key in bridge.endpoints:
            return
        shown = bridge.endpoints[key] = list(self._endpoints(bridge, token))
        for endpoint in shown:
            self._use(endpoint.node)
            self._graph.add_endpoint(endpoint)
            self._state.tell_writers(endpoint, present=True)

    def _hide(self, bridge: Bridge, key: str) -> None:
        hidden = bridge.endpoints.pop(key, [])
        for endpoint in hidden:
            if self._graph is not None:
                self._graph.remove_endpoint(endpoint)
            self._unuse(endpoint.node)
            self._state.tell_writers(endpoint, present=False)

    def _endpoints(self, bridge: Bridge, token: BridgeToken) -> Iterator[EndpointInfo]:
        """Yield the endpoints of a token: one per node if the nodes are known, otherwise one."""
        zid = bridge.node.participant
        for announced in bridged_endpoints(token):
            for node in self._nodes_of(bridge, announced):
                yield EndpointInfo(
                    kind=announced.kind,
                    node=node,
                    endpoint_id=self._new_id(),
                    name=announced.name,
                    type_name=announced.type_name,
                    type_hash=token.type_hash,
                    qos=announced.qos,
                    gid=gid_of(f"{zid} {announced.kind.value} {announced.name} {node}"),
                )

    def _nodes_of(self, bridge: Bridge, endpoint: BridgedEndpoint) -> list[NodeInfo]:
        """Return the nodes that have an endpoint, as far as they are known."""
        zid = bridge.node.participant
        on_dds = (endpoint.kind, "/" + endpoint.name[1:].removeprefix(bridge.prefix))
        names = [
            f"/{bridge.prefix}{node.name[1:]}" for node in bridge.nodes if on_dds in node.endpoints
        ]
        if not names:
            owner, _, last = endpoint.name.rpartition("/")
            is_server = endpoint.kind is EndpointKind.SERVER
            if not (is_server and owner and last in NODE_SERVICES):
                return [bridge.node]
            if not endpoint.type_name.startswith(NODE_PACKAGES):
                return [bridge.node]
            names = [owner]
        return [self._node(zid, name) for name in dict.fromkeys(names)]

    def _node(self, zid: str, full_name: str) -> NodeInfo:
        """Return the entry of a node, which stays the same as long as it has endpoints."""
        namespace, _, name = full_name.rpartition("/")
        for known in self._users:
            if known.participant == zid and known.fully_qualified_name == full_name:
                return known
        return NodeInfo(zid, self._new_id(), name, namespace or "/", bridged=True)

    def _new_id(self) -> int:
        self._next_id += 1
        return self._next_id

    def _use(self, node: NodeInfo) -> None:
        self._users[node] = self._users.get(node, 0) + 1
        if self._graph is not None:
            self._graph.add_node(node)

    def _unuse(self, node: NodeInfo) -> None:
        self._users[node] -= 1
        if not self._users[node]:
            del self._users[node]
            if self._graph is not None:
                self._graph.remove_node(node)
