"""The nodes and endpoints that a context knows of, and queries about them.

`Graph` is a store that the context and its transports write to. It does no I/O: a transport adds
what it discovers, the context adds its own nodes and endpoints, and each change wakes the tasks
that wait for one. The graph watcher of a transport,
`engine/transport/zenoh/discovery/graph_watcher.py`, adds the nodes of other processes, and removes
those of a process that ends or dies.
"""

from __future__ import annotations

import asyncio
import enum
from collections import defaultdict
from typing import TYPE_CHECKING, Literal, TypeAlias, TypeVar

from msgspec import Struct, structs

from aionode import names, qos
from aionode._distribution import NO_TYPE_HASH, distribution_mismatch
from aionode._process.concurrency import running_loop
from aionode.errors import EntityDestroyedError
from aionode.qos import QoSProfile

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator
    from collections.abc import Set as AbstractSet


__all__ = [
    "SERVICE_KINDS",
    "TOPIC_KINDS",
    "EndpointInfo",
    "EndpointKind",
    "Graph",
    "Mismatch",
    "NodeInfo",
    "Offered",
    "is_infrastructure",
]

K = TypeVar("K")
V = TypeVar("V")

Watcher: TypeAlias = "Callable[[EndpointInfo, bool], None]"


class EndpointKind(enum.Enum):
    """The kind of an endpoint."""

    PUBLISHER = "publisher"
    SUBSCRIPTION = "subscription"
    SERVER = "server"
    CLIENT = "client"

    @property
    def opposite(self) -> EndpointKind:
        """The kind of endpoint that this kind communicates with."""
        return OPPOSITES[self]


OPPOSITES = {
    EndpointKind.PUBLISHER: EndpointKind.SUBSCRIPTION,
    EndpointKind.SUBSCRIPTION: EndpointKind.PUBLISHER,
    EndpointKind.SERVER: EndpointKind.CLIENT,
    EndpointKind.CLIENT: EndpointKind.SERVER,
}


class NodeInfo(Struct, frozen=True):
    """One node in the graph.

    Attributes:
        participant: Id of the context that runs the node, in hexadecimal.
        node_id: Number of the node, unique in its context.
        name: Its name without namespace.
        namespace: Its namespace, beginning with a slash.
        enclave: Its security enclave.
        over_rcl: Whether it was discovered by rcl, over a middleware such as DDS, which connects
            endpoints only if their QoS is compatible, and may not report type hashes.
        bridged: Whether it is on DDS, behind a `zenoh-bridge-ros2dds`; then `participant` is the
            Zenoh id of that bridge.
    """

    participant: str
    node_id: int
    name: str
    namespace: str
    enclave: str = "/"
    over_rcl: bool = False
    bridged: bool = False

    @property
    def fully_qualified_name(self) -> str:
        """The namespace and name combined."""
        return names.fully_qualified_name(self.namespace, self.name)


class Offered(Struct, frozen=True):
    """The contents of a graph, by name.

    Attributes:
        nodes: Full names of nodes.
        topics: Topics that a node publishes or subscribes to, with their types.
        services: Services that a node serves, with their types.
        actions: Actions that a node serves, with their types.
    """

    nodes: list[str]
    topics: dict[str, list[str]]
    services: dict[str, list[str]]
    actions: dict[str, list[str]]


class Mismatch(Struct, frozen=True):
    """Why two opposite endpoints of one name do not communicate.

    Attributes:
        aspect: What differs: the name of the type, its definition, the distribution of ROS 2, or
            the QoS.
        reason: Both values, as text.
        policy: The last incompatible policy, if the QoS differs.
    """

    aspect: Literal["type", "definition", "distribution", "qos"]
    reason: str
    policy: qos.QoSPolicyKind = qos.QoSPolicyKind.INVALID


class EndpointInfo(Struct, frozen=True, eq=False):
    """One publisher, subscription, server or client in the graph.

    Two are equal if their `gid` is equal, since that identifies an endpoint.

    Attributes:
        kind: What it does.
        node: The node that it belongs to.
        endpoint_id: Number of the endpoint, unique in its context.
        name: Full name of its topic or service.
        type_name: ROS name of its type, such as ``std_msgs/msg/String``.
        type_hash: RIHS01 hash of the type, as text; ``TypeHashNotSupported`` from ROS 2 Humble, and
            empty if unknown, as for services over DDS.
        qos: Its QoS.
        gid: 16 bytes that identify it.
        backends: The memory in which an endpoint of another process passes byte sequences, such as
            ``backends:cpu:``, as announced since ROS 2 Lyrical; otherwise empty.
    """

    kind: EndpointKind
    node: NodeInfo
    endpoint_id: int
    name: str
    type_name: str
    type_hash: str
    qos: QoSProfile
    gid: bytes
    backends: str = ""

    def __eq__(self, other: object) -> bool:
        return isinstance(other, EndpointInfo) and self.gid == other.gid

    def __hash__(self) -> int:
        return hash(self.gid)

    def compare(self, other: EndpointInfo) -> Mismatch | None:
        """Return the first difference to the opposite endpoint `other`; None if there is none.

        A difference in QoS matters within one context, and between contexts over DDS; rmw_zenoh
        delivers between contexts whatever the QoS is. A bridge adapts to both sides, but DDS
        subscriptions that request earlier messages may refuse a volatile publisher. An unknown
        hash, such as that of a service behind a bridge, counts as equal to any.
        """
        different = self._compare_types(other)
        if different is not None or self.kind not in TOPIC_KINDS:
            return different  # services neither offer nor request QoS
        is_publisher = self.kind is EndpointKind.PUBLISHER
        publisher, subscription = (self, other) if is_publisher else (other, self)
        refusals = qos.incompatibilities(publisher.qos, subscription.qos)
        if publisher.node.bridged or subscription.node.bridged:
            refused = subscription.node.bridged and not publisher.node.bridged
            durability = qos.QoSPolicyKind.DURABILITY
            refusals = [entry for entry in refusals if refused and entry.kind is durability]
        if not refusals:
            return None
        return Mismatch("qos", "; ".join(entry.reason for entry in refusals), refusals[-1].kind)

    def _compare_types(self, other: EndpointInfo) -> Mismatch | None:
        if self.type_name != other.type_name:
            return Mismatch("type", f"type: {self.type_name} here, {other.type_name} there")
        if self._has_other_hash(other):
            reason = distribution_mismatch(self.type_hash, other.type_hash)
            if reason is not None:
                return Mismatch("distribution", reason)
            hashes = f"{self.type_hash} here, {other.type_hash} there"
            return Mismatch("definition", f"definition of {self.type_name}: {hashes}")
        return None

    def _has_other_hash(self, other: EndpointInfo) -> bool:
        """Whether both announce a type hash, and the two differ; over DDS there are none."""
        hashes = {self.type_hash, other.type_hash}
        if self.node.bridged or other.node.bridged:
            hashes -= {NO_TYPE_HASH}
        return len(hashes - {""}) > 1

    def mismatch(self, other: EndpointInfo) -> str | None:
        """Return why this endpoint and its opposite `other` do not communicate; None if they do.

        Between contexts over rmw_zenoh only the types matter, since it delivers whatever the QoS
        is; `needs_qos` lists the exceptions.
        """
        mismatch = self.compare(other) if self.needs_qos(other) else self._compare_types(other)
        return None if mismatch is None else mismatch.reason

    def needs_qos(self, other: EndpointInfo) -> bool:
        """Return whether the two have to be compatible in QoS.

        They do within one context, and over DDS. Since ROS 2 Lyrical, volatile publishers of byte
        sequences also send on keys that transient local subscriptions do not listen to.
        """
        if self.kind in TOPIC_KINDS:
            is_publisher = self.kind is EndpointKind.PUBLISHER
            publisher, subscription = (self, other) if is_publisher else (other, self)
            is_latched = subscription.qos.durability is qos.DurabilityPolicy.TRANSIENT_LOCAL
            if publisher.backends and is_latched:
                return True
        in_one_context = self.node.participant == other.node.participant
        return in_one_context or self.node.over_rcl or other.node.over_rcl

    def matches(self, other: EndpointInfo) -> bool:
        """Whether this endpoint communicates with its opposite `other`."""
        return self.mismatch(other) is None


class Graph:
    """The nodes and endpoints known now.

    Endpoints are indexed by name and by node, so the cost of a query depends on its answer and not
    on the size of the system.

    Args:
        participant: Id of the context whose graph this is.

    Attributes:
        changes: Incremented by each change; an answer is valid while this stays the same.
        router_lost_ns: When the connection to a router was last lost, by `perf_ns`; whatever
            disappeared about then may only be unreachable.
        unreported: Which mismatches of an endpoint of this context are not logged because its
            program gets them as events: ``"qos"``, ``"type"`` and ``"definition"``.
    """

    def __init__(self, participant: str = "") -> None:
        self.changes = 0
        self._participant = participant
        self._closed = False
        self._nodes: dict[NodeInfo, None] = {}
        self._endpoints: dict[EndpointInfo, None] = {}
        self._by_name: dict[tuple[EndpointKind, str], dict[EndpointInfo, None]] = defaultdict(dict)
        self._by_node: dict[NodeInfo, dict[EndpointInfo, None]] = defaultdict(dict)
        # Those of this context; searching among all of them would be quadratic.
        self._own: dict[tuple[EndpointKind, str], dict[EndpointInfo, None]] = defaultdict(dict)
        # Futures of `changed` by the name they wait for (None: any), until its next change.
        self._waiters: dict[str | None, dict[asyncio.Future[None], None]] = {}
        self._nodes_by_name: dict[str, dict[NodeInfo, None]] = defaultdict(dict)
        self._listeners: list[Callable[[EndpointInfo], None]] = []
        self._node_listeners: list[Callable[[NodeInfo], None]] = []
        self._watchers: dict[tuple[EndpointKind, str], list[Watcher]] = {}
        self.router_lost_ns = -(1 << 62)
        self.unreported: dict[EndpointInfo, AbstractSet[str]] = {}

    def __repr__(self) -> str:
        return f"<Graph: {len(self._nodes)} nodes, {len(self._endpoints)} endpoints>"

    # Changes

    def add_node(self, node: NodeInfo) -> None:
        """Add a node; adding it again has no effect."""
        if node not in self._nodes:
            self._nodes[node] = None
            self._nodes_by_name[node.fully_qualified_name][node] = None
            for listener in self._node_listeners:
                listener(node)
            self._wake(node.fully_qualified_name)

    def remove_node(self, node: NodeInfo) -> None:
        """Remove `node`, if it is known."""
        if node in self._nodes:
            del self._nodes[node]
            _take_out(self._nodes_by_name, node.fully_qualified_name, node)
            self._wake(node.fully_qualified_name)

    def add_endpoint(self, endpoint: EndpointInfo) -> None:
        """Add `endpoint`; adding it again has no effect."""
        if endpoint in self._endpoints:
            return
        self._endpoints[endpoint] = None
        self._by_name[endpoint.kind, endpoint.name][endpoint] = None
        self._by_node[endpoint.node][endpoint] = None
        if self._is_own(endpoint):
            self._own[endpoint.kind, endpoint.name][endpoint] = None
        self.changes += 1  # before listeners query the graph
        for listener in self._listeners:
            listener(endpoint)
        self._tell_watchers(endpoint, present=True)
        self._wake(endpoint.name)

    def remove_endpoint(self, endpoint: EndpointInfo) -> None:
        """Remove `endpoint`, if it is known."""
        if endpoint not in self._endpoints:
            return
        del self._endpoints[endpoint]
        _take_out(self._by_name, (endpoint.kind, endpoint.name), endpoint)
        _take_out(self._by_node, endpoint.node, endpoint)
        if self._is_own(endpoint):
            _take_out(self._own, (endpoint.kind, endpoint.name), endpoint)
        self.unreported.pop(endpoint, None)
        self._tell_watchers(endpoint, present=False)
        self._wake(endpoint.name)

    def identify(self, endpoint: EndpointInfo, gid: bytes) -> None:
        """Set the gid of an endpoint to the one that the middleware has chosen.

        Watchers see it leave and return; for listeners it stays the same endpoint.
        """
        is_known = endpoint in self._endpoints
        if is_known:
            self._tell_watchers(endpoint, present=False)
            indices = [
                self._endpoints,
                self._by_name[endpoint.kind, endpoint.name],
                self._by_node[endpoint.node],
            ]
            if self._is_own(endpoint):
                indices.append(self._own[endpoint.kind, endpoint.name])
            for index in indices:
                del index[endpoint]
        unreported = self.unreported.pop(endpoint, None)
        structs.force_setattr(endpoint, "gid", gid)  # frozen for everyone else
        if unreported is not None:
            self.unreported[endpoint] = unreported
        if is_known:
            for index in indices:
                index[endpoint] = None
            self.changes += 1
            self._tell_watchers(endpoint, present=True)

    def remove_participant(self, participant: str) -> None:
        """Remove all nodes and endpoints of the context `participant`.

        Called only when this context ends; graph watchers remove the nodes and endpoints of dead
        processes.
        """
        for endpoint in [e for e in self._endpoints if e.node.participant == participant]:
            self.remove_endpoint(endpoint)
        for node in [n for n in self._nodes if n.participant == participant]:
            self.remove_node(node)

    def on_endpoint(self, listener: Callable[[EndpointInfo], None]) -> None:
        """Call `listener` with each endpoint added from now on."""
        self._listeners.append(listener)

    def on_node(self, listener: Callable[[NodeInfo], None]) -> None:
        """Call `listener` with each node added from now on."""
        self._node_listeners.append(listener)

    def watch(self, kind: EndpointKind, name: str, watcher: Watcher) -> Callable[[], None]:
        """Call `watcher` for each endpoint of `kind` and `name` that is present, appears or leaves.

        Its second argument says whether the endpoint is present. Returns a function that removes
        the watcher.
        """
        watchers = self._watchers.setdefault((kind, name), [])
        watchers.append(watcher)
        for endpoint in self.endpoints(kind, name=name):
            watcher(endpoint, True)

        def unwatch() -> None:
            watchers.remove(watcher)
            if not watchers and self._watchers.get((kind, name)) is watchers:
                del self._watchers[kind, name]

        return unwatch

    def _is_own(self, endpoint: EndpointInfo) -> bool:
        return endpoint.node.participant == self._participant

    def _tell_watchers(self, endpoint: EndpointInfo, *, present: bool) -> None:
        for watcher in tuple(self._watchers.get((endpoint.kind, endpoint.name), ())):
            watcher(endpoint, present)

    def changed(self, *full_names: str) -> asyncio.Future[None]:
        """Return a future that is done at the next change: a node or endpoint added or removed.

        Await it, or keep it to cancel the wait from elsewhere; cancelling is safe. The graph
        belongs to the context, so the end of a node is a change and does not end the wait. The
        future raises EntityDestroyedError once the context has been shut down and closed.

        Args:
            full_names: Full names of topics, services or nodes: if given, only changes of nodes and
                endpoints with one of these names end the wait. In a large system this costs much
                less than looking again at every change.
        """
        waiter: asyncio.Future[None] = running_loop().create_future()
        if self._closed:
            end(waiter)
            return waiter
        keys = full_names or (None,)
        for key in keys:
            self._waiters.setdefault(key, {})[waiter] = None

        def forget(_: asyncio.Future[None]) -> None:
            for key in keys:
                if key in self._waiters:
                    self._waiters[key].pop(waiter, None)
                    if not self._waiters[key]:
                        del self._waiters[key]

        waiter.add_done_callback(forget)
        return waiter

    async def until(self, condition: Callable[[], bool], *full_names: str) -> None:
        """Wait until `condition()` is true; it is called at each change, as by `changed`.

        Raises:
            EntityDestroyedError: the context has been shut down and closed.
        """
        while not condition():
            await self.changed(*full_names)

    def close(self) -> None:
        """End all waits, as nothing changes any more; called by the context after its shutdown."""
        self._closed = True
        for waiters in list(self._waiters.values()):
            for waiter in list(waiters):
                end(waiter)

    def _wake(self, full_name: str) -> None:
        self.changes += 1
        for key in (full_name, None):
            for waiter in self._waiters.pop(key, ()):
                if not waiter.done():
                    waiter.set_result(None)

    # Queries

    def nodes(self) -> list[NodeInfo]:
        """Return every node, in the order in which they were added."""
        return list(self._nodes)

    def nodes_named(self, fully_qualified_name: str) -> list[NodeInfo]:
        """Return the nodes of this name; more than one is a mistake that ROS 2 allows."""
        return list(self._nodes_by_name.get(fully_qualified_name, ()))

    def endpoints(
        self, *kinds: EndpointKind, name: str | None = None, node: NodeInfo | None = None
    ) -> list[EndpointInfo]:
        """Return the endpoints of these kinds (default: all) with this name and node."""
        kinds = kinds or tuple(EndpointKind)
        candidates: Iterable[EndpointInfo]
        if name is not None:
            candidates = (e for kind in kinds for e in self._by_name.get((kind, name), ()))
        else:
            candidates = self._by_node.get(node, ()) if node is not None else self._endpoints
            candidates = (e for e in candidates if e.kind in kinds)
        return [e for e in candidates if node is None or e.node == node]

    def own(self) -> list[EndpointInfo]:
        """Return the endpoints of this context."""
        return [endpoint for group in self._own.values() for endpoint in group]

    def own_opposites(self, endpoint: EndpointInfo) -> list[EndpointInfo]:
        """Return the endpoints of this context that have the name and the opposite kind."""
        return list(self._own.get((endpoint.kind.opposite, endpoint.name), ()))

    def opposites(self, endpoint: EndpointInfo) -> list[EndpointInfo]:
        """Return all endpoints that have the name and the opposite kind."""
        return list(self._by_name.get((endpoint.kind.opposite, endpoint.name), ()))

    def count(self, kind: EndpointKind, name: str) -> int:
        """Return how many endpoints of `kind` have the full name `name`."""
        return len(self._by_name.get((kind, name), ()))

    def names_and_types(
        self, *kinds: EndpointKind, node: NodeInfo | None = None
    ) -> list[tuple[str, list[str]]]:
        """Return the sorted names of endpoints of these kinds, each with its types."""
        types: dict[str, set[str]] = defaultdict(set)
        for endpoint in self.endpoints(*kinds, node=node):
            types[endpoint.name].add(endpoint.type_name)
        return [(name, sorted(types[name])) for name in sorted(types)]

    def offered(self, *, user_only: bool = True) -> Offered:
        """Return what the nodes offer, sorted, as tools, agents and pages need it.

        Most of the names of a system are of its infrastructure: every node serves its parameters,
        publishes its log and describes its types, and an action is three services and two topics.

        Args:
            user_only: Whether to leave out infrastructure (see `is_infrastructure`) and hidden
                nodes with all that only they have. Otherwise everything is there, and actions also
                with the services and topics that they consist of.
        """

        def is_left_out(name: str) -> bool:
            return user_only and names.is_hidden(name)

        topics, services, actions = (defaultdict[str, set[str]](set) for _ in range(3))
        for endpoint in self._endpoints:
            kind, name = endpoint.kind, endpoint.name
            if kind is EndpointKind.CLIENT or is_left_out(endpoint.node.fully_qualified_name):
                continue
            action = name.removesuffix(SEND_GOAL) if kind is EndpointKind.SERVER else name
            if action != name and not is_left_out(action):
                actions[action].add(endpoint.type_name.removesuffix(SEND_GOAL_TYPE))
            if not (user_only and is_infrastructure(endpoint)):
                of_kind = topics if kind in TOPIC_KINDS else services
                of_kind[name].add(endpoint.type_name)
        nodes = {node.fully_qualified_name for node in self._nodes}
        return Offered(
            sorted(node for node in nodes if not is_left_out(node)),
            *(
                {name: sorted(types[name]) for name in sorted(types)}
                for types in (topics, services, actions)
            ),
        )

    def find_nodes(self, fully_qualified_name: str) -> Iterator[NodeInfo]:
        """Return an iterator over the nodes of this full name; names need not be unique."""
        return iter(self.nodes_named(fully_qualified_name))


def is_infrastructure(endpoint: EndpointInfo) -> bool:
    """Return whether an endpoint belongs to ROS itself rather than to its node's author.

    Infrastructure is: hidden names (such as the topics and services of actions), ``/rosout`` and
    ``/parameter_events``, the services of parameters, loggers and type descriptions, the services
    that query the states of managed nodes, and rosapi. The service that changes the state of a
    managed node is not infrastructure: the node offers it to its users.
    """
    if names.is_hidden(endpoint.name) or endpoint.name in INFRASTRUCTURE_TOPICS:
        return True
    return endpoint.kind in SERVICE_KINDS and endpoint.type_name.startswith(INFRASTRUCTURE_TYPES)


def end(waiter: asyncio.Future[None]) -> None:
    """End a wait with an error, as the context is destroyed."""
    if not waiter.done():
        waiter.set_exception(EntityDestroyedError("context"))
        waiter.exception()  # mark it retrieved: perhaps nobody awaits it any more


def _take_out(index: dict[K, dict[V, None]], key: K, member: V) -> None:
    """Remove `member` from its group, and the group if it is then empty."""
    del index[key][member]
    if not index[key]:
        del index[key]


TOPIC_KINDS = (EndpointKind.PUBLISHER, EndpointKind.SUBSCRIPTION)
SERVICE_KINDS = (EndpointKind.SERVER, EndpointKind.CLIENT)

INFRASTRUCTURE_TOPICS = frozenset({"/rosout", "/parameter_events"})

INFRASTRUCTURE_TYPES = (
    "rcl_interfaces/srv/",
    "type_description_interfaces/srv/",
    "rosapi_msgs/srv/",
    "lifecycle_msgs/srv/GetAvailable",
)
"""The prefixes of the types of services that query nodes, whoever wrote the nodes."""

SEND_GOAL = "/_action/send_goal"
SEND_GOAL_TYPE = "_SendGoal"
