"""A stand-in for `zenoh-bridge-ros2dds` and the DDS nodes behind it: Zenoh without aionode.

It behaves as the plugin's source and runs against it have shown: keys, tokens, routes and their
end, the ids of requests, and its own answers. It also records what would have crashed the real one.

``python -m tests.support.bridge`` runs one in a process: `/chatter` counts ten times a second, and
`/add_two_ints` adds.
"""

from __future__ import annotations

import asyncio
import json
import os
import struct
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager
from typing import Any

import zenoh  # noqa: TID251  # plays the bridge, without aionode
from zenoh import ext  # noqa: TID251

__all__ = [
    "ADD",
    "CYCLONE",
    "FAST",
    "HEADER",
    "STRING",
    "StandIn",
    "cause_of_death",
    "stand_in",
]

HEADER = bytes.fromhex("00010000")
STRING = "std_msgs/msg/String"
ADD = "example_interfaces/srv/AddTwoInts"
CYCLONE = ":1::0,10"
"""The QoS of a reliable topic of depth 10, as a node on Cyclone DDS is announced."""
LATCHED = ":1:1:0,10"
FAST = ":1::"
"""The same of a node on Fast DDS, which does not tell its history."""

REMOTE = zenoh.Locality.REMOTE


def string(text: str) -> bytes:
    """Return a std_msgs/msg/String."""
    data = text.encode() + b"\0"
    return HEADER + struct.pack("<I", len(data)) + data


def cause_of_death(token: str, namespace: str = "/") -> str | None:
    """Return why a token below ``@/<zid>/@ros2_lv`` would crash a bridge; None if it would not.

    Args:
        token: The token.
        namespace: The bridge's namespace. The plugin (`key_expr_to_ros2_name`) removes it from a
            key that begins with its letters, and later one more character for the slash.
    """
    rest = token.split("/", 3)[3:]
    if not rest:
        return None
    if len(rest[0].encode()) < 3:
        return "fewer than three bytes"
    chunks = rest[0].split("/")
    if chunks[0] not in {"MP", "MS", "SS", "SC", "AS", "AC"}:
        return None  # only a warning
    for chunk in chunks[1:3]:
        if "" in chunk.split("§"):
            return f"an empty part in {chunk}"
    if len(chunks) < 3:
        return "no type"
    own, key = namespace.strip("/"), chunks[1].replace("§", "/")
    if own and key.startswith(own) and (key[len(own) + 1 :] or "/")[0] == "/":
        return f"no name left of {key}"
    return None


class StandIn:
    """One bridge, and the DDS nodes behind it.

    Args:
        session: Its session.
        namespace: The namespace of its configuration.
        joins_late: How many queries for its settings get no answer. A real bridge has its token
            before its DDS participant, and declares its queryable later.

    Attributes:
        zid: Its id.
        deaths: What would have killed it: tokens, and payloads on its keys.
        announced: The tokens of others that exist now.
        seen: All tokens of others that ever existed.
        received: The payloads that DDS subscriptions received, by topic.
    """

    def __init__(self, session: zenoh.Session, namespace: str = "/", joins_late: int = 0) -> None:
        self.session = session
        self.zid = str(session.zid())
        self.deaths: list[str] = []
        self.announced: set[str] = set()
        self.seen: set[str] = set()
        self.received: dict[str, list[bytes]] = {}
        self.nodes: dict[str, dict[str, Any]] = {}
        self.served: list[bytes] = []
        self._prefix = namespace.strip("/") + "/" if namespace.strip("/") else ""
        self._declared: dict[str, list[Any]] = {}
        self._cut: set[str] = set()
        self._requests = 0
        self._silent = joins_late
        self._config = {"domain": 0, "namespace": namespace, "nodename": "zenoh_bridge_ros2dds"}
        self._admin = session.declare_queryable(f"@/{self.zid}/ros2/**", self._answer)
        self._watch = session.liveliness().declare_subscriber(
            "@/*/@ros2_lv/**", self._see, history=True
        )
        self._listen = session.declare_subscriber("**", self._check, allowed_origin=REMOTE)
        self._hear = session.declare_queryable("**", self._check_query, allowed_origin=REMOTE)
        self.token = session.liveliness().declare_token(f"@/{self.zid}/@ros2_lv")

    def key(self, name: str) -> str:
        """Return the key of a topic or service on DDS."""
        return self._prefix + name.strip("/")

    def announce(self, kind: str, name: str, type_name: str, qos: str | None = None) -> Any:
        """Declare the token of a DDS endpoint."""
        chunks = [self.key(name).replace("/", "§"), type_name.replace("/", "§")]
        if qos is not None:
            chunks.append(qos)
        return self.session.liveliness().declare_token(
            "/".join(["@", self.zid, "@ros2_lv", kind, *chunks])
        )

    # What others declare and send

    def _see(self, sample: zenoh.Sample) -> None:
        token = str(sample.key_expr)
        if token.split("/")[1] == self.zid:
            return
        if sample.kind == zenoh.SampleKind.PUT:
            self.announced.add(token)
            self.seen.add(token)
            cause = cause_of_death(token, self._prefix)
            if cause is not None:
                self.deaths.append(f"{token}: {cause}")
            return
        self.announced.discard(token)
        chunks = token.split("/")
        if chunks[3:4] == ["MS"]:
            # The DDS reader goes with the last token of a key, even if there are other subscribers.
            same = [one for one in self.announced if one.split("/")[3:5] == chunks[3:5]]
            if not [one for one in same if one.split("/")[1] == chunks[1]]:
                self._cut.add(chunks[4].replace("§", "/"))

    def _check(self, sample: zenoh.Sample) -> None:
        """Record data that DDS readers could not decode, on keys that pass the bridge."""
        key = str(sample.key_expr)
        if not key.startswith(self._prefix) or "::" in key:  # of rmw_zenoh
            return
        payload = sample.payload.to_bytes()
        if sample.kind != zenoh.SampleKind.PUT:
            self.deaths.append(f"{key}: a delete")
        elif len(payload) < 5 or payload[:2] not in {b"\0\0", b"\0\1"}:
            self.deaths.append(f"{key}: {payload.hex()}")

    def _check_query(self, query: zenoh.Query) -> None:
        """Record invalid requests that would reach DDS servers."""
        key = str(query.key_expr)
        with query:
            if key.startswith(self._prefix) and "::" not in key and query.payload is None:
                self.deaths.append(f"{key}: a query without a request")

    def _answer(self, query: zenoh.Query) -> None:
        asked = str(query.key_expr)
        answers: dict[str, Any] = {"config": self._config, "version": "v1.10.2"}
        answers |= {f"node/{key}": value for key, value in self.nodes.items()}
        with query:
            if self._silent:
                self._silent -= 1
                return
            for key, value in answers.items():
                full = f"@/{self.zid}/ros2/{key}"
                if zenoh.KeyExpr(asked).intersects(zenoh.KeyExpr(full)):
                    query.reply(full, json.dumps(value).encode())

    # DDS

    def publisher(
        self, name: str, type_name: str = STRING, qos: str = CYCLONE
    ) -> Callable[[bytes], None]:
        """Create a DDS publisher, and return the function that publishes."""
        key = self.key(name)
        # A reliable route blocks: a reader that hangs holds up the robot.
        reliable = qos.split(":")[1] == "1"
        route = ext.declare_advanced_publisher(
            self.session,
            key,
            cache=ext.CacheConfig(max_samples=100) if qos == LATCHED else None,
            publisher_detection=qos == LATCHED,
            reliability=zenoh.Reliability.RELIABLE,
            congestion_control=(
                zenoh.CongestionControl.BLOCK if reliable else zenoh.CongestionControl.DROP
            ),
            allowed_destination=REMOTE,
        )
        self._declared[f"publisher {name}"] = [self.announce("MP", name, type_name, qos), route]

        def publish(payload: bytes) -> None:
            if key not in self._cut:
                route.put(payload)

        return publish

    def subscribe(self, name: str, type_name: str = STRING, qos: str = CYCLONE) -> list[bytes]:
        """Create a DDS subscription, and return the list of what it receives."""
        key = self.key(name)
        received = self.received.setdefault(name, [])

        def take(sample: zenoh.Sample) -> None:
            received.append(sample.payload.to_bytes())

        if qos == LATCHED:
            route: Any = ext.declare_advanced_subscriber(
                self.session,
                key,
                take,
                history=ext.HistoryConfig(detect_late_publishers=True, max_samples=10),
                allowed_origin=REMOTE,
            )
        else:
            route = self.session.declare_subscriber(key, take, allowed_origin=REMOTE)
        self._declared[f"subscription {name}"] = [self.announce("MS", name, type_name, qos), route]
        return received

    def serve(
        self, name: str, type_name: str, answer: Callable[[bytes], bytes | None], kind: str = "SS"
    ) -> None:
        """Create a DDS server; None stands for no answer, as from a server on Fast DDS."""

        def take(query: zenoh.Query) -> None:
            payload = b"" if query.payload is None else query.payload.to_bytes()
            self.served.append(payload)
            if payload[:2] not in {b"\0\0", b"\0\1"}:
                self.deaths.append(f"{query.key_expr}: the request {payload.hex()}")
                return
            response = answer(payload)
            if response is None:
                held.append(query)  # it is never answered
            else:
                query.reply(query.key_expr, response)
                query.drop()

        held: list[zenoh.Query] = []
        route = self.session.declare_queryable(self.key(name), take, allowed_origin=REMOTE)
        declared = [route]
        if kind:
            declared.insert(0, self.announce(kind, name, type_name))
        self._declared[f"server {name}"] = declared

    def call(self, name: str, request: bytes, timeout_s: float = 5.0) -> list[bytes]:
        """Call a service as a DDS node, and return all responses, of which the last counts."""
        self._requests += 1
        extra = b"rqh" + bytes(range(8)) + struct.pack("<q", self._requests) + b"\1"
        replies = self.session.get(
            self.key(name),
            payload=request,
            attachment=extra,
            target=zenoh.QueryTarget.ALL,
            consolidation=zenoh.ConsolidationMode.NONE,
            timeout=timeout_s,
            allowed_destination=REMOTE,
        )
        found = []
        for reply in replies:
            if reply.ok is not None:
                assert reply.ok.attachment is None
                found.append(reply.ok.payload.to_bytes())
        return found

    def end(self, what: str) -> None:
        """End a DDS endpoint, such as ``publisher /chatter``."""
        for one in self._declared.pop(what):
            one.undeclare()


def add(request: bytes) -> bytes:
    """Serve AddTwoInts."""
    a, b = struct.unpack_from("<qq", request, 4)
    return HEADER + struct.pack("<q", a + b)


@contextmanager
def stand_in(namespace: str = "/", *, first: bool = True, joins_late: int = 0) -> Iterator[StandIn]:
    """Run a stand-in that listens on the port of routers, or dials a router that does."""
    listen = os.environ["AIONODE_ROUTER_PORT"] if first else "0"
    port = os.environ["AIONODE_MEETING_PORTS"].split(",")[0]
    config = zenoh.Config()
    for key, value in {
        "mode": "router",
        "listen/endpoints": [f"tcp/127.0.0.1:{listen}"],
        "connect/endpoints": [f"tcp/127.0.0.1:{port}"],
        "connect/timeout_ms": -1,
        "connect/exit_on_failure": False,
        "connect/retry": {
            "period_init_ms": 50,
            "period_max_ms": 100,
            "period_increase_factor": 2,
        },
        "scouting/multicast/enabled": False,
        "timestamping/enabled": True,
    }.items():
        config.insert_json5(key, json.dumps(value))
    with closing(zenoh.open(config)) as session:
        yield StandIn(session, namespace, joins_late)


async def main() -> None:
    """Run as a bridge until the process is killed."""
    with stand_in() as bridge:
        publish = bridge.publisher("/chatter")
        bridge.serve("/add_two_ints", ADD, add)
        print("ready", flush=True)  # noqa: T201
        number = 0
        while True:
            publish(string(str(number)))
            number += 1
            await asyncio.sleep(0.1)  # noqa: TID251  # a bridge has no clock of aionode


if __name__ == "__main__":
    asyncio.run(main())
