"""Liveliness tokens: the ROS graph as Zenoh key expressions.

Each node and each endpoint declares one token for as long as it exists::

    @ros2_lv/<domain>/<zid>/<nid>/<nid>/NN/<enclave>/<namespace>/<node>
    @ros2_lv/<domain>/<zid>/<nid>/<eid>/<kind>/<enclave>/<namespace>/<node>/<name>/<type>/<hash>/<qos>

A name is one chunk, with each slash replaced by ``%``. The QoS chunk omits values equal to
rmw_zenoh's defaults. Since ROS 2 Lyrical, a 14th chunk ``backends:…`` may follow.

Parsing is lenient: it never raises, and returns None for a token of unknown format or with a name
that ROS does not allow, as any program may declare any token with this prefix.
"""

from __future__ import annotations

import re
from functools import lru_cache
from typing import Final

import xxhash
from msgspec import Struct

from aionode.clock import CONST_INFINITE_NS, S_TO_NS, Duration
from aionode.engine.wire._key_expression import dds_type, demangle, mangle, ros_type
from aionode.graph import EndpointInfo, EndpointKind, NodeInfo
from aionode.names import is_full_name, is_full_node_name
from aionode.qos import (
    DEFAULT_DEPTH,
    DurabilityPolicy,
    HistoryPolicy,
    LivelinessPolicy,
    QoSProfile,
    ReliabilityPolicy,
)

__all__ = [
    "CPU_BACKEND",
    "PREFIX",
    "Token",
    "endpoint_token",
    "gid_of",
    "is_node_token",
    "node_token",
    "parse_qos",
    "parse_token",
    "qos_chunk",
]

PREFIX: Final = "@ros2_lv"

BACKENDS: Final = "backends:"

CPU_BACKEND: Final = f"{BACKENDS}cpu:"
"""The 14th chunk of a subscription that also accepts plain bytes on the buffer key."""

NODE_KIND: Final = "NN"
KIND_CHUNKS: Final = {
    EndpointKind.PUBLISHER: "MP",
    EndpointKind.SUBSCRIPTION: "MS",
    EndpointKind.SERVER: "SS",
    EndpointKind.CLIENT: "SC",
}
KINDS: Final = {chunk: kind for kind, chunk in KIND_CHUNKS.items()}

CHUNK: Final = "[A-Za-z0-9_%@:,.+~-]+"
NUMBER: Final = "([0-9]{1,20})"

TOKEN: Final = re.compile(
    f"{PREFIX}/{NUMBER}/({CHUNK})/{NUMBER}/{NUMBER}" + f"/({CHUNK})" * 4 + f"((?:/{CHUNK})*)"
)
"""A token, of the characters that `is_plain` allows; every process parses those of all others."""

ENDPOINT_CHUNKS: Final = 4
"""Minimum number of chunks in the token of an endpoint besides those in the token of its node."""

MAX_TOKEN: Final = 4096
"""Maximum token length in characters: ROS names have at most 255, and a token has five."""

QOS_CHUNKS: Final = 256
"""Number of different QoS chunks whose profiles are cached."""

SHARED: Final = 1024
"""Number of nodes, names and types that are cached, so that endpoints share the objects."""

FOREVER: Final = divmod(CONST_INFINITE_NS, S_TO_NS)


class Token(Struct, frozen=True):
    """A parsed liveliness token."""

    domain_id: int
    info: NodeInfo | EndpointInfo


# Writing


def node_token(domain_id: int, node: NodeInfo) -> str:
    """Return the token of a node."""
    return "/".join(node_chunks(domain_id, node, node.node_id, NODE_KIND))


def is_node_token(token: str) -> bool:
    """Return whether a token is that of a node."""
    return token.split("/", 6)[5:6] == [NODE_KIND]


def endpoint_token(domain_id: int, endpoint: EndpointInfo, backends: str = "") -> str:
    """Return the token of an endpoint; its `gid` is not part of the token, but derived from it."""
    chunks = [
        *node_chunks(domain_id, endpoint.node, endpoint.endpoint_id, KIND_CHUNKS[endpoint.kind]),
        mangle(endpoint.name),
        mangle(dds_type(endpoint.type_name)),
        mangle(endpoint.type_hash),
        qos_chunk(endpoint.qos),
    ]
    if backends:
        chunks.append(backends)
    return "/".join(chunks)


def node_chunks(domain_id: int, node: NodeInfo, entity_id: int, kind: str) -> list[str]:
    """Return the chunks that the tokens of nodes and endpoints have in common."""
    return [
        PREFIX,
        str(domain_id),
        node.participant,
        str(node.node_id),
        str(entity_id),
        kind,
        mangle(node.enclave or "/"),
        mangle(node.namespace or "/"),
        node.name,
    ]


def gid_of(token: str) -> bytes:
    """Return the 16 bytes that identify an entity in attachments and in the graph.

    They are derived from its token alone: XXH3-128, low half first, each half little-endian.
    """
    return xxhash.xxh3_128_digest(token.encode())[::-1]


def qos_chunk(qos: QoSProfile) -> str:
    """Return the QoS chunk of a profile, with system defaults resolved as in rmw_zenoh."""
    qos = qos.resolved()
    lease = duration_text(qos.liveliness_lease_duration)
    return ":".join(
        (
            elided(qos.reliability, ReliabilityPolicy.RELIABLE),
            elided(qos.durability, DurabilityPolicy.VOLATILE),
            f"{elided(qos.history, HistoryPolicy.KEEP_LAST)},{elided(qos.depth, DEFAULT_DEPTH)}",
            duration_text(qos.deadline),
            duration_text(qos.lifespan),
            f"{elided(qos.liveliness, LivelinessPolicy.AUTOMATIC)},{lease}",
        )
    )


def elided(value: int, default: int) -> str:
    """Return `value` as text, empty for the default."""
    return "" if value == default else str(int(value))


def duration_text(duration: Duration) -> str:
    """Return seconds and nanoseconds as text; the parts of an infinite duration are omitted."""
    parts = divmod(duration.nanoseconds, S_TO_NS)
    return ",".join(elided(*pair) for pair in zip(parts, FOREVER, strict=True))


# Reading


def parse_token(key: str) -> Token | None:
    """Parse a token; return None if its format is unknown."""
    found = TOKEN.fullmatch(key) if len(key) <= MAX_TOKEN else None
    if found is None:
        return None
    domain, zid, node_id, entity_id, kind, enclave, namespace, name, rest = found.groups()
    node = shared_node(zid, int(node_id), name, namespace, enclave)
    if node is None:
        return None
    if kind == NODE_KIND:
        return Token(int(domain), node)
    endpoint = parse_endpoint(key, node, int(entity_id), kind, rest[1:].split("/"))
    return None if endpoint is None else Token(int(domain), endpoint)


def parse_endpoint(
    key: str, node: NodeInfo, endpoint_id: int, kind: str, chunks: list[str]
) -> EndpointInfo | None:
    """Return the endpoint described by the last chunks of its token."""
    if kind not in KINDS or len(chunks) < ENDPOINT_CHUNKS:
        return None
    name_chunk, dds_name, type_hash, qos_text = chunks[:4]
    name = shared_name(name_chunk)
    type_name, hash_text = shared_type(dds_name, type_hash)
    qos = parse_qos(qos_text)
    if name is None or type_name is None or qos is None:
        return None
    backends = next(iter(chunks[4:]), "")
    return EndpointInfo(
        KINDS[kind],
        node,
        endpoint_id,
        name,
        type_name,
        hash_text,
        qos,
        gid_of(key),
        backends if backends.startswith(BACKENDS) else "",
    )


@lru_cache(SHARED)
def shared_node(zid: str, node_id: int, name: str, namespace: str, enclave: str) -> NodeInfo | None:
    """Return the node for some chunks, or None if invalid; equal chunks share one object."""
    node = NodeInfo(zid, node_id, name, demangle(namespace), demangle(enclave))
    return node if is_full_node_name(name, node.namespace, node.enclave) else None


@lru_cache(SHARED)
def shared_name(chunk: str) -> str | None:
    """Return the topic or service name in a chunk, or None if invalid; equal chunks share it."""
    name = demangle(chunk)
    return name if is_full_name(name) else None


@lru_cache(SHARED)
def shared_type(dds_name: str, type_hash: str) -> tuple[str | None, str]:
    """Return a type's name, or None if invalid, and its hash; equal ones share objects."""
    return ros_type(demangle(dds_name)), demangle(type_hash)


def parse_qos(chunk: str) -> QoSProfile | None:
    """Return the profile described by a QoS chunk, or None if its format is unknown."""
    profile = cached_profile(chunk)
    return None if profile is None else profile.replace()  # a copy, as profiles are mutable


@lru_cache(QOS_CHUNKS)
def cached_profile(chunk: str) -> QoSProfile | None:
    """Return a cached profile for a chunk: there are few different ones, and each takes 20 µs."""
    fields = [field.split(",") for field in chunk.split(":")]
    if len(fields) < 6 or any(
        len(parts) < needed for parts, needed in zip(fields, (1, 1, 2, 2, 2, 3), strict=False)
    ):
        return None
    history = fields[2]
    liveliness = fields[5]
    try:
        return QoSProfile(
            reliability=ReliabilityPolicy(value(fields[0][0], ReliabilityPolicy.RELIABLE)),
            durability=DurabilityPolicy(value(fields[1][0], DurabilityPolicy.VOLATILE)),
            history=HistoryPolicy(value(history[0], HistoryPolicy.KEEP_LAST)),
            depth=value(history[1], DEFAULT_DEPTH) or DEFAULT_DEPTH,
            deadline=parse_duration(fields[3]),
            lifespan=parse_duration(fields[4]),
            liveliness=LivelinessPolicy(value(liveliness[0], LivelinessPolicy.AUTOMATIC)),
            liveliness_lease_duration=parse_duration(liveliness[1:]),
        )
    except ValueError:
        return None


def parse_duration(parts: list[str]) -> Duration:
    """Return the duration given as seconds and nanoseconds.

    Raises:
        ValueError: a part is not a number, or is too large.
    """
    seconds, nanoseconds = (value(*pair) for pair in zip(parts[:2], FOREVER, strict=True))
    return Duration(nanoseconds=min(seconds * S_TO_NS + nanoseconds, CONST_INFINITE_NS))


def value(text: str, default: int) -> int:
    """Return the number in `text`, or `default` if it is empty.

    Raises:
        ValueError: `text` is not a number.
    """
    if not text:
        return int(default)
    result = number(text)
    if result is None:
        raise ValueError(text)
    return result


def number(text: str) -> int | None:
    """Return a decimal number, or None; int() would also accept signs, blanks and underscores."""
    return int(text) if text.isascii() and text.isdigit() and len(text) <= 20 else None
