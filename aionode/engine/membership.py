"""What a node needs of its context: joining it, keeping it open, announcing endpoints.

These are functions, as users see the methods of a `Context`.
"""

from __future__ import annotations

import contextlib
from typing import TYPE_CHECKING, Any, TypeVar

from msgspec import structs

from aionode._distribution import NO_TYPE_HASH
from aionode.arguments import Usage
from aionode.engine.transport.base import Registration
from aionode.engine.wire._liveliness import endpoint_token, gid_of
from aionode.engine.wire.typehash import type_hash
from aionode.graph import EndpointInfo, EndpointKind, NodeInfo
from aionode.message import Message, holds_arrays, type_name, unserialized
from aionode.qos import best_available_for_publisher, best_available_for_subscription

if TYPE_CHECKING:
    import asyncio
    from collections.abc import Callable, Iterator

    from aionode.arguments import Arguments
    from aionode.engine.context import Context, ContextNode
    from aionode.engine.loop_affinity import LoopAffinity
    from aionode.engine.transport.base import Transport
    from aionode.qos import QoSProfile

__all__ = [
    "acquire",
    "affinity_of",
    "describe_endpoint",
    "describe_node",
    "join",
    "load_arrays",
    "nodes_of",
    "register",
    "release",
    "usage_of",
    "with_arguments",
]

RegisteredT = TypeVar("RegisteredT", bound=Registration)


def join(
    context: Context, node: ContextNode, info: NodeInfo, abandon: Callable[[], None]
) -> Callable[[], None]:
    """Announce a node, which `Context.shutdown` destroys; return a function that withdraws it.

    Args:
        context: The context that it joins.
        node: The node.
        info: Its entry in the graph, of `describe_node`.
        abandon: Called in a forked child; marks the node destroyed without closing anything.

    Raises:
        EntityDestroyedError: the context was shut down.
        ForkedProcessError: it belongs to the parent of this forked process.
    """
    context._refuse_if_shut_down()
    context._refuse_if_inherited()
    registrations = register(context, lambda transport: transport.create_node(info))
    context._nodes[node] = abandon
    context.graph.add_node(info)

    def leave() -> None:
        for registration in registrations:
            registration.close()
        context.graph.remove_node(info)
        del context._nodes[node]

    return leave


def nodes_of(context: Context) -> list[ContextNode]:
    """Return the nodes of a context that are not destroyed, in order of creation."""
    return list(context._nodes)


async def acquire(context: Context) -> None:
    """Keep a context open until `release`; the first user opens the transports.

    Raises:
        RuntimeError: the context is open in another event loop.
        ForkedProcessError: it is the parent's, or the parent was connected (a RuntimeError).
    """
    await context._acquire()


async def release(context: Context, task: asyncio.Task[Any] | None) -> None:
    """Undo one `acquire` of `task`; the last user closes the transports.

    Must not be cancelled half-way: call it through `to_the_end`.
    """
    await context._release(task)


def affinity_of(context: Context) -> LoopAffinity:
    """Return the event loop that the nodes of a context run in."""
    return context._affinity


def usage_of(context: Context) -> Usage:
    """Return the record of which current arguments of a context its nodes have used."""
    return context._current_usage


@contextlib.contextmanager
def with_arguments(context: Context, arguments: Arguments) -> Iterator[None]:
    """Apply `arguments` to the nodes of one context within the ``with`` block."""
    before, context._usage = context._usage, Usage(arguments)
    try:
        yield
    finally:
        context._usage = before


def register(context: Context, create: Callable[[Transport], RegisteredT]) -> list[RegisteredT]:
    """Create something in every transport of a context, or in none if one refuses."""
    registrations: list[RegisteredT] = []
    try:
        registrations.extend(map(create, context.transports))
    except BaseException:
        for registration in registrations:
            registration.close()
        raise
    return registrations


def describe_node(context: Context, name: str, namespace: str, enclave: str) -> NodeInfo:
    """Return the graph entry of a new node."""
    return NodeInfo(context.participant, next(context._ids), name, namespace, enclave)


def describe_endpoint(
    context: Context,
    kind: EndpointKind,
    node: NodeInfo,
    name: str,
    ros_type: Any,
    profile: QoSProfile,
) -> EndpointInfo:
    """Return the graph entry of a new endpoint; its profile is adapted to opposite ones."""
    others = [other.qos for other in context.graph.endpoints(kind.opposite, name=name)]
    if kind is EndpointKind.PUBLISHER:
        profile = best_available_for_publisher(profile, others)
    elif kind is EndpointKind.SUBSCRIPTION:
        profile = best_available_for_subscription(profile, others)
    endpoint = EndpointInfo(
        kind=kind,
        node=node,
        endpoint_id=next(context._ids),
        name=name,
        type_name=type_name(ros_type),
        type_hash=NO_TYPE_HASH if context.ros_distro == "humble" else type_hash(ros_type),
        qos=profile.resolved(),
        gid=b"",
    )
    gid = gid_of(endpoint_token(context.network.domain_id, endpoint))
    return structs.replace(endpoint, gid=gid)


def load_arrays(ros_type: Any) -> None:
    """Import numpy if a message or service type has array fields, before a callback needs it.

    A node's built-in services have such fields too, but do without it: see `cdr.decode_request`.
    Types whose messages stay encoded need none.
    """
    halves = (ros_type,) if issubclass(ros_type, Message) else (ros_type.Request, ros_type.Response)
    if any(unserialized(half) is half and holds_arrays(half) for half in halves):
        import numpy  # noqa: F401, ICN001  # imported ahead of use
