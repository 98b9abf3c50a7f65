"""Announcements of `zenoh-bridge-ros2dds`: of the nodes behind it, and of ours to it.

A bridge is a Zenoh router with a DDS participant. The key of a topic or service is its ROS name
without the leading slash, domain, type and hash. It announces itself and what it has found::

    @/<zid>/@ros2_lv
    @/<zid>/@ros2_lv/<MP|MS>/<key>/<type>/<qos>
    @/<zid>/@ros2_lv/<SS|SC|AS|AC>/<key>/<type>

Key and type are one chunk each, with ``§`` for each slash. Nodes have no tokens, and an action has
a single one for all of its services and topics.

Bridges trust these tokens: a last chunk with a kind of fewer than three bytes, or a name with an
empty part, ends the bridge's main task, and with it the robot's connection. So `bridge_token` is
the only function that creates one, and it rejects whatever a bridge would not survive. What only a
bridge with a certain namespace would not survive is detected by `takes_for_its_own`.
"""

from __future__ import annotations

import re
from typing import Final

from msgspec import Struct
from msgspec.structs import replace

from aionode.graph import EndpointInfo, EndpointKind
from aionode.qos import (
    DurabilityPolicy,
    HistoryPolicy,
    QoSProfile,
    ReliabilityPolicy,
    depth_of,
    keeps_all,
)

__all__ = [
    "BRIDGES",
    "BridgeToken",
    "BridgedEndpoint",
    "BridgedNode",
    "bridge_key",
    "bridge_token",
    "bridged_endpoints",
    "config_key",
    "namespace_prefix",
    "node_keys",
    "parse_bridge_token",
    "parse_node",
    "parse_request_id",
    "takes_for_its_own",
    "token_of",
]

BRIDGES: Final = "@/*/@ros2_lv"
"""The key expression of the tokens of bridges; what is behind a bridge is announced below it."""

MARK: Final = "@ros2_lv"
SLASH: Final = "§"

KINDS: Final = {
    "MP": EndpointKind.PUBLISHER,
    "MS": EndpointKind.SUBSCRIPTION,
    "SS": EndpointKind.SERVER,
    "SC": EndpointKind.CLIENT,
}
KIND_CHUNKS: Final = {kind: chunk for chunk, kind in KINDS.items()}
ACTION_KINDS: Final = {"AS": EndpointKind.SERVER, "AC": EndpointKind.CLIENT}

# Compiled by their first use, as most programs meet no bridge.
ZID: Final = r"[0-9a-f]{1,32}\Z"
# ROS names, which contain nothing that Zenoh or a bridge would interpret differently.
NAME: Final = r"[A-Za-z0-9_]+(/[A-Za-z0-9_]+)*\Z"
TYPE: Final = r"[A-Za-z0-9_]+/(msg|srv|action)/[A-Za-z0-9_]+\Z"
HASH: Final = r"RIHS01_[0-9a-f]{64}\Z"

ACTION_PART: Final = "/_action/"
SEND_GOAL: Final = "_SendGoal"

REQUEST_ID_SIZE: Final = 20
REQUEST_MARK: Final = b"rqh"


class BridgeToken(Struct, frozen=True):
    """A parsed token.

    Attributes:
        zid: The Zenoh id of the session that declared it.
        kind: ``MP``, ``MS``, ``SS``, ``SC``, ``AS`` or ``AC``; empty for the bridge itself.
        key: The key of the topic, service or action.
        type_name: The ROS name of its type.
        qos: Its QoS; the default for services and actions.
        type_hash: The hash of the type; empty if unknown.
        has_history: Whether the QoS includes a history, which Fast DDS does not transmit.
    """

    zid: str
    kind: str = ""
    key: str = ""
    type_name: str = ""
    qos: QoSProfile = QoSProfile(depth=10)
    type_hash: str = ""
    has_history: bool = True


class BridgedEndpoint(Struct, frozen=True):
    """One endpoint that a token stands for; an action has five of them."""

    kind: EndpointKind
    name: str
    type_name: str
    qos: QoSProfile


class BridgedNode(Struct, frozen=True):
    """A node behind a bridge, as the bridge describes it.

    Attributes:
        name: Its full name on the DDS side.
        endpoints: Kinds and names of its topics and services, including those of its actions.
        uses_fast_dds: Whether it uses Fast DDS, according to the id of its participant.
    """

    name: str
    endpoints: frozenset[tuple[EndpointKind, str]]
    uses_fast_dds: bool


def bridge_key(name: str) -> str:
    """Return the key of a topic or service.

    Raises:
        ValueError: it is not a fully qualified ROS name.
    """
    key = name.strip("/")
    if not re.match(NAME, key):
        raise ValueError(f"{name!r} is not the name of a topic, service or action")
    return key


def namespace_prefix(namespace: str) -> str:
    """Return the prefix of a bridge's keys, such as ``bot1/``; empty for the root namespace."""
    prefix = namespace.strip("/")
    return f"{prefix}/" if re.match(NAME, prefix) else ""


def takes_for_its_own(prefix: str, key: str) -> bool:
    """Return whether a bridge mistakes `key` for one in its namespace.

    It compares without the slash, and so mistakes ``bot10/chatter`` for a part of ``bot1``. It then
    cuts off the prefix and one more character, and crashes if no name is left.
    """
    return bool(prefix) and key.startswith(prefix[:-1]) and not key.startswith(prefix)


def bridge_token(
    zid: str,
    kind: str,
    name: str,
    type_name: str,
    qos: QoSProfile | None = None,
    type_hash: str = "",
) -> str:
    """Create a token that a bridge can parse; nothing else may declare anything below ``@/``.

    Args:
        zid: The id of the session that declares it.
        kind: ``MP``, ``MS``, ``SS``, ``SC``, ``AS`` or ``AC``.
        name: The full name of the topic, service or action.
        type_name: The ROS name of its type.
        qos: The QoS of a topic.
        type_hash: The hash of a topic's type, if known.

    Raises:
        ValueError: a part is not what a bridge expects.
    """
    key = bridge_key(name)
    if not re.match(ZID, zid):
        raise ValueError(f"{zid!r} is not a session id")
    if kind not in KINDS and kind not in ACTION_KINDS:
        raise ValueError(f"{kind!r} is not a kind of token")
    if not re.match(TYPE, type_name):
        raise ValueError(f"{type_name!r} is not the name of a type")
    chunks = ["@", zid, MARK, kind, key.replace("/", SLASH), type_name.replace("/", SLASH)]
    if kind in {"MP", "MS"}:
        if qos is None:
            raise ValueError(f"{name}: the token of a topic needs its QoS")
        chunks.append(qos_chunk(qos, type_hash))
    return "/".join(chunks)


def qos_chunk(qos: QoSProfile, type_hash: str) -> str:
    """Return the QoS as DDS numbers; the first field would be K for a keyed topic."""
    qos = qos.resolved()
    reliable = int(qos.reliability is ReliabilityPolicy.RELIABLE)
    transient = int(qos.durability is DurabilityPolicy.TRANSIENT_LOCAL)
    text = f":{reliable}:{transient}:{int(keeps_all(qos))},{depth_of(qos)}"
    return f"{text}:typehash={type_hash};" if re.match(HASH, type_hash) else text


def token_of(zid: str, endpoint: EndpointInfo) -> str:
    """Return the token of one of our endpoints; empty if another endpoint's token stands for it.

    Of an action's endpoints, the one that sends goals has the action's token.
    """
    action, part, which = endpoint.name.partition(ACTION_PART)
    if not part:
        kind = KIND_CHUNKS[endpoint.kind]
        return bridge_token(
            zid, kind, endpoint.name, endpoint.type_name, endpoint.qos, endpoint.type_hash
        )
    if which != "send_goal" or not endpoint.type_name.endswith(SEND_GOAL):
        return ""
    kind = "AS" if endpoint.kind is EndpointKind.SERVER else "AC"
    return bridge_token(zid, kind, action, endpoint.type_name.removesuffix(SEND_GOAL))


# Reading


def parse_bridge_token(key: str) -> BridgeToken | None:
    """Parse a token; return None if its format is unknown."""
    chunks = key.split("/")
    if len(chunks) < 3 or chunks[0] != "@" or chunks[2] != MARK:
        return None
    zid = chunks[1]
    if len(chunks) == 3:
        return BridgeToken(zid)
    if len(chunks) < 6:
        return None
    kind = chunks[3]
    name, type_name = (chunk.replace(SLASH, "/") for chunk in chunks[4:6])
    if kind not in KINDS and kind not in ACTION_KINDS:
        return None
    if not (re.match(NAME, name) and re.match(TYPE, type_name)):
        return None
    if kind not in {"MP", "MS"}:
        return BridgeToken(zid, kind, name, type_name)
    return parse_topic(BridgeToken(zid, kind, name, type_name), "/".join(chunks[6:]))


def parse_topic(token: BridgeToken, text: str) -> BridgeToken | None:
    """Add the QoS to the token of a topic; return None if it cannot be parsed.

    Unset policies have DDS's defaults, by which publishers are reliable and subscriptions are not.
    """
    fields = text.split(":", 4)
    if len(fields) < 4:
        return None
    reliability, durability, history = fields[1:4]
    reliable = reliability == "1" or (not reliability and token.kind == "MP")
    kind, _, depth = history.partition(",")
    if not all(part in {"", "0", "1"} for part in (reliability, durability, kind)):
        return None
    match = re.search(r"typehash=([^;]*)", fields[4]) if len(fields) > 4 else None
    type_hash = match[1] if match and re.match(HASH, match[1]) else ""
    known_depth = int(depth) if depth.isascii() and depth.isdigit() and len(depth) < 10 else 0
    qos = QoSProfile(
        reliability=ReliabilityPolicy.RELIABLE if reliable else ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.TRANSIENT_LOCAL
        if durability == "1"
        else DurabilityPolicy.VOLATILE,
        history=HistoryPolicy.KEEP_ALL if kind == "1" else HistoryPolicy.KEEP_LAST,
        depth=max(known_depth, 1),
    )
    return replace(token, qos=qos, type_hash=type_hash, has_history=bool(history))


def bridged_endpoints(token: BridgeToken) -> list[BridgedEndpoint]:
    """Return the endpoints that a token stands for."""
    name = f"/{token.key}"
    if token.kind in KINDS:
        return [BridgedEndpoint(KINDS[token.kind], name, token.type_name, token.qos)]
    server = ACTION_KINDS[token.kind] is EndpointKind.SERVER
    service = EndpointKind.SERVER if server else EndpointKind.CLIENT
    topic = EndpointKind.PUBLISHER if server else EndpointKind.SUBSCRIPTION
    status = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    qos = QoSProfile(depth=10)
    parts = (
        (service, "send_goal", f"{token.type_name}{SEND_GOAL}", qos),
        (service, "cancel_goal", "action_msgs/srv/CancelGoal", qos),
        (service, "get_result", f"{token.type_name}_GetResult", qos),
        (topic, "feedback", f"{token.type_name}_FeedbackMessage", qos),
        (topic, "status", "action_msgs/msg/GoalStatusArray", status),
    )
    return [
        BridgedEndpoint(kind, f"{name}{ACTION_PART}{part}", type_name, hash_)
        for kind, part, type_name, hash_ in parts
    ]


def config_key(zid: str) -> str:
    """Return the key under which a bridge publishes its settings."""
    return f"@/{zid}/ros2/config"


def node_keys(zid: str) -> str:
    """Return the key expression for querying the nodes of a bridge."""
    return f"@/{zid}/ros2/node/**"


LISTS: Final = (
    ("publishers", "MP"),
    ("subscribers", "MS"),
    ("service_servers", "SS"),
    ("service_clients", "SC"),
    ("action_servers", "AS"),
    ("action_clients", "AC"),
)

FAST_DDS: Final = "010f"
"""The first two bytes of a participant's id: the vendor, according to the RTPS specification."""


def parse_node(key: str, payload: bytes) -> BridgedNode | None:
    """Parse the description of a node by a bridge; return None if its format is unknown.

    Args:
        key: ``@/<zid>/ros2/node/<gid>/<namespace>/<name>``.
        payload: JSON with its endpoints.
    """
    chunks = key.split("/", 5)
    if len(chunks) < 6 or chunks[2:4] != ["ros2", "node"]:
        return None
    gid, name = chunks[4].replace(".", ""), chunks[5].replace(SLASH, "/").strip("/")
    if not re.match(NAME, name):
        return None
    import json  # nodes that meet no bridge need none

    try:
        described = json.loads(payload)
        endpoints = {
            (endpoint.kind, endpoint.name)
            for listed, kind in LISTS
            for entry in described.get(listed, ())
            for endpoint in bridged_endpoints(BridgeToken("", kind, entry["name"].strip("/")))
        }
    except (ValueError, TypeError, LookupError, AttributeError, RecursionError):
        return None
    return BridgedNode(f"/{name}", frozenset(endpoints), gid.startswith(FAST_DDS))


def parse_request_id(extra: bytes) -> tuple[bytes, int] | None:
    """Return the client and sequence number of a request through a bridge; None for others.

    The attachment is ``rqh``, the client id (8 bytes), the sequence number (8), and the byte order.
    """
    if len(extra) != REQUEST_ID_SIZE or not extra.startswith(REQUEST_MARK):
        return None
    sequence = int.from_bytes(extra[11:19], "little" if extra[-1] else "big", signed=True)
    return extra[3:11].ljust(16, b"\0"), sequence
