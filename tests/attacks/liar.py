"""The tools of an attacker: a plain Zenoh session that sends what no aionode program would.

It shares only keys and encodings with aionode: any program on the network can send the same.
"""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, closing, contextmanager, suppress
from typing import Any

import zenoh  # plays another participant, without aionode

from aionode.engine.transport.reliability import submessage as acknack
from aionode.engine.transport.reliability.submessage import SubmessageKind
from aionode.engine.transport.zenoh.delivery.acknowledgements import submessage_key
from aionode.engine.wire import _attachment as attachment
from aionode.engine.wire import cdr
from aionode.engine.wire._key_expression import Side, data_key
from aionode.engine.wire._liveliness import endpoint_token, gid_of, node_token, parse_token
from aionode.engine.wire.typehash import type_hash
from aionode.graph import EndpointInfo, EndpointKind, NodeInfo
from aionode.message import type_name
from aionode.qos import QoSProfile
from tests.support.peers import raw_session

__all__ = ["LIAR", "Liar", "lying", "pace"]

LIAR = "liar"
"""The name of its node."""

GRAPH_S = 5.0
"""How long it waits at most for an endpoint that it is to see."""


def pace(seconds: float, per_s: float) -> Iterator[int]:
    """Yield numbers from 0 on for some time, at a rate per second."""
    began_s, number = time.monotonic(), 0
    while (now_s := time.monotonic()) < began_s + seconds:
        due_s = began_s + number / per_s
        if due_s > now_s:
            time.sleep(min(due_s - now_s, seconds))
            continue
        yield number
        number += 1


@contextmanager
def lying() -> Iterator[Liar]:
    """A liar with a session: a member of the domain, or whatever its certificate allows."""
    with ExitStack() as stack:
        path = os.environ.get("ZENOH_SESSION_CONFIG_URI")
        if path:
            session = stack.enter_context(closing(zenoh.open(zenoh.Config.from_file(path))))
        else:
            session = stack.enter_context(raw_session())
        yield Liar(session)


class Liar:
    """The actions of an attacker with a session.

    Args:
        session: The session.
    """

    def __init__(self, session: zenoh.Session) -> None:
        self.session = session
        self.domain = int(os.environ["ROS_DOMAIN_ID"])
        self.participant = str(session.zid())
        self.node = NodeInfo(self.participant, 0, LIAR, "/", "/")
        self.held: list[Any] = []
        self.descriptions: dict[str, Any] = {}
        self._known: dict[tuple[EndpointKind, str], list[EndpointInfo]] = {}
        self._entities = 0

    # What others announce

    def endpoints(self, kind: EndpointKind, name: str) -> list[EndpointInfo]:
        """Return the endpoints of others with this kind and name; wait for the first one.

        Raises:
            LookupError: there is none.
        """
        ends_s = time.monotonic() + GRAPH_S
        while time.monotonic() < ends_s:
            found = []
            for reply in self.session.liveliness().get(f"@ros2_lv/{self.domain}/**"):
                token = None if reply.ok is None else parse_token(str(reply.ok.key_expr))
                if token is not None and isinstance(token.info, EndpointInfo):
                    found.append(token.info)
            theirs = [
                each
                for each in found
                if each.kind is kind
                and each.name == name
                and each.node.participant != self.participant
            ]
            if theirs:
                return theirs
            time.sleep(0.1)
        raise LookupError(f"{kind.name} {name}: no node announces it")

    def known(self, kind: EndpointKind, name: str) -> list[EndpointInfo]:
        """Return the endpoints as they were at the first call."""
        found = self._known.get((kind, name))
        if found is None:
            found = self._known[kind, name] = self.endpoints(kind, name)
        return found

    # What it announces

    def hold(self, token: str) -> None:
        """Declare a token for as long as the session is open."""
        self.held.append(self.session.liveliness().declare_token(token))

    def drop(self) -> None:
        """Withdraw everything."""
        held, self.held = self.held, []
        self.descriptions.clear()
        for each in held:
            with suppress(zenoh.ZError):
                each.undeclare()

    def be_node(self, name: str = LIAR) -> None:
        """Announce a node, and that this session acknowledges messages."""
        self.node = NodeInfo(self.participant, self.node.node_id, name, "/", "/")
        self.hold(node_token(self.domain, self.node))
        self.hold(f"@aionode/{self.domain}/{self.participant}/reliable/{acknack.VERSION}")

    def token(
        self,
        kind: EndpointKind,
        name: str,
        interface: Any,
        qos: QoSProfile | None = None,
        hash_text: str = "",
    ) -> str:
        """Return the token of another endpoint of its own.

        Args:
            kind: Its kind.
            name: Of the topic or service.
            interface: Its class, or the name of a type that has none.
            qos: The profile.
            hash_text: The type hash, for a type without a class.
        """
        self._entities += 1
        named = isinstance(interface, str)
        info = EndpointInfo(
            kind,
            self.node,
            self._entities,
            name,
            interface if named else type_name(interface),
            hash_text if named else type_hash(interface),
            qos or QoSProfile(depth=10),
            b"",
        )
        return endpoint_token(self.domain, info)

    def announce(
        self, kind: EndpointKind, name: str, interface: Any, qos: QoSProfile | None = None
    ) -> bytes:
        """Announce another endpoint, and return its gid."""
        token = self.token(kind, name, interface, qos)
        self.hold(token)
        return gid_of(token)

    # What it sends

    def key(self, name: str, interface: Any) -> str:
        """Return the key of a topic or service."""
        return data_key(self.domain, name, type_name(interface), type_hash(interface))

    def put(self, key: str, payload: bytes, extra: bytes | None = None) -> None:
        """Send anything on a key, as fast as the session takes it."""
        self.session.put(
            key, payload, attachment=extra, congestion_control=zenoh.CongestionControl.BLOCK
        )

    def publish(self, topic: str, message: Any, sequence: int, gid: bytes) -> None:
        """Send a message as the publisher with this gid."""
        extra = attachment.pack(sequence, time.time_ns(), gid)
        self.put(self.key(topic, type(message)), cdr.encode(message), extra)

    def submessage(
        self,
        kind: SubmessageKind,
        writer: EndpointInfo,
        reader: EndpointInfo,
        first: int,
        last: int,
        rest: bytes = b"",
    ) -> None:
        """Send a submessage as a writer to its reader, or an ACKNACK as the reader."""
        key = self.submessage_key(kind, writer, reader)
        self.put(key, acknack.pack(kind, writer.gid, reader.gid, first, last, rest))

    def submessage_key(
        self, kind: SubmessageKind, writer: EndpointInfo, reader: EndpointInfo
    ) -> str:
        """Return the key on which a writer or reader of a topic would send submessages."""
        key = data_key(self.domain, writer.name, writer.type_name, writer.type_hash)
        if kind is SubmessageKind.ACKNACK:
            return submessage_key(key, Side.SUBSCRIPTIONS, writer.node.participant)
        return submessage_key(key, Side.PUBLISHERS, reader.node.participant)

    def post(self, reader: EndpointInfo, batch: bytes) -> None:
        """Send frames to a context as if a link had failed to deliver them."""
        self.put(f"@aionode/{self.domain}/{reader.node.participant}/post", batch)

    def ask(self, service: str, interface: Any, request: Any, *, wait_s: float = 0.0) -> int:
        """Send a request; return the size of its answer, or 0 without waiting for one.

        Args:
            service: Its name.
            interface: Its class.
            request: The request, or bytes in its place.
            wait_s: How long to wait for the answer; 0 not to wait.
        """
        self._entities += 1
        payload = request if isinstance(request, bytes) else cdr.encode(request)
        extra = attachment.pack(self._entities, time.time_ns(), os.urandom(16))
        replies = self.session.get(
            self.key(service, interface), payload=payload, attachment=extra, timeout=wait_s or 1.0
        )
        if not wait_s:
            self.held.append(Kept(replies))
            return 0
        return sum(len(each.ok.payload) for each in replies if each.ok is not None)

    def serve(self, service: str, interface: Any, answer: Callable[[Any], Any]) -> None:
        """Answer requests of others with what `answer` returns: a response, or bytes."""
        key = self.key(service, interface)

        def take(query: zenoh.Query) -> None:
            payload = b"" if query.payload is None else query.payload.to_bytes()
            made = answer(cdr.decode(interface.Request, payload))
            with query:
                query.reply(
                    key,
                    made if isinstance(made, bytes) else cdr.encode(made),
                    attachment=query.attachment,
                )

        self.held.append(self.session.declare_queryable(key, take, complete=True))
        self.announce(EndpointKind.SERVER, service, interface)


class Kept:
    """Keeps an object, as long as the tokens beside it are held."""

    def __init__(self, *what: object) -> None:
        self._what: Sequence[object] = what

    def undeclare(self) -> None:
        """Release it."""
        self._what = ()
