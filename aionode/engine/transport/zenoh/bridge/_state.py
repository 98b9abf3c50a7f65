"""The state shared by our endpoints on bridges' keys: names, tokens, declarations."""

from __future__ import annotations

import logging
from typing import TYPE_CHECKING, Any, Final

from aionode.engine.transport.drops import Drop
from aionode.engine.transport.zenoh._session_state import Declaration, EndpointNames, SessionState
from aionode.engine.transport.zenoh.delivery.acknowledgements import Acknowledgements
from aionode.engine.wire._bridge import bridge_key, takes_for_its_own, token_of

if TYPE_CHECKING:
    import zenoh

    from aionode.clock import TimeBase
    from aionode.engine.transport.loop_waker import LoopWaker
    from aionode.engine.transport.zenoh.bridge._placeholders import Placeholder
    from aionode.engine.transport.zenoh.session.announced import AnnouncedLimit
    from aionode.graph import EndpointInfo, Graph, NodeInfo

__all__ = ["BridgeDeclaration", "BridgeState"]

logger = logging.getLogger("aionode.transport.zenoh")

MAX_NAMESPACES: Final = 100
"""Maximum number of bridge namespaces: each is compared with each name of this context."""


class SharedToken:
    """A token that lasts as long as any of our endpoints needs it.

    A bridge knows one token of each kind and key per session: the end of a second one would end the
    traffic of the first.
    """

    def __init__(self, tokens: dict[str, SharedToken], name: str, declared: Any) -> None:
        self._tokens = tokens
        self._name = name
        self._declared = declared
        self.users = 1

    def undeclare(self) -> None:
        """Withdraw the token when its last user is gone."""
        self.users -= 1
        if not self.users:
            del self._tokens[self._name]
            self._declared.undeclare()


class Unacknowledged(Acknowledgements):
    """No acknowledgements, as nothing behind a bridge sends any."""

    def start(self, session: zenoh.Session) -> None:  # noqa: ARG002  # nothing is declared
        """Call `tick` of publishers from now on."""
        self._is_open = True


class BridgeState(SessionState):
    """The connection of one context to the bridges it sees; open while there are any.

    Args:
        participant: Id of the context, and of its session.
        domain_id: The ROS domain.
        time_base: The time of the context.
        waker: Wakes the event loop; the session's.

    Attributes:
        prefixes: The key prefix of each bridge, by its Zenoh id; empty for the root namespace.
        fast_dds: The bridges with nodes on Fast DDS, whose services do not answer.
        placeholders: Stand in for endpoints created before the first bridge.
    """

    def __init__(
        self,
        participant: str,
        domain_id: int,
        time_base: TimeBase | None,
        waker: LoopWaker,
    ) -> None:
        super().__init__(participant, domain_id, time_base, waker)
        self.acknowledgements = Unacknowledged(
            *(participant, domain_id, waker, self.note_malformed, lambda _: None),
            self.announced,
            self.control_messages,
        )
        self.prefixes: dict[str, str] = {}
        self.fast_dds: set[str] = set()
        self.placeholders: dict[Placeholder[Any], None] = {}
        self._served: set[str] = set()  # all prefixes ever seen; declarations stay
        self._tokens: dict[str, SharedToken] = {}
        self._warned_of: set[str] = set()

    def follow(self, announced: AnnouncedLimit) -> None:
        """Count bridges' announcements together with the session's other endpoints."""
        self.announced = announced
        announced.on_crowded.append(self.note_crowd)

    def connect(self, session: zenoh.Session, graph: Graph) -> None:
        """Create all endpoints, as this is the first bridge."""
        super().connect(session, graph)
        placeholders = list(self.placeholders)
        self.placeholders.clear()
        for placeholder in placeholders:
            placeholder.replace()

    def names_of(self, endpoint: EndpointInfo, backends: str = "") -> EndpointNames:  # noqa: ARG002  # of rmw_zenoh only
        """Return the names of one of our endpoints."""
        token = token_of(self.participant, endpoint)
        return EndpointNames(bridge_key(endpoint.name), token, endpoint.gid)

    def reaches(self, node: NodeInfo) -> bool:
        """Return whether `node` is behind a bridge."""
        return node.bridged

    def declare_token(self, session: zenoh.Session, token: str) -> Any:
        """Declare a token, or reuse the existing one of its kind and key."""
        name = "/".join(token.split("/")[:5])
        shared = self._tokens.get(name)
        if shared is not None:
            shared.users += 1
            return shared
        declared = super().declare_token(session, token)
        shared = self._tokens[name] = SharedToken(self._tokens, name, declared)
        return shared

    def serves(self, key: str) -> bool:
        """Return whether messages on `key` pass a bridge, and all bridges survive its token."""
        if not any(key.startswith(prefix) for prefix in self._served):
            return False
        for prefix in self._served:
            if takes_for_its_own(prefix, key):
                self._warn_of_namespace(prefix.rstrip("/"), key)
                return False
        return True

    def _warn_of_namespace(self, namespace: str, key: str) -> None:
        """Log once per namespace why names like `key` do not pass any bridge."""
        if namespace not in self._warned_of:
            self._warned_of.add(namespace)
            logger.warning(
                "/%s is not announced to any zenoh-bridge-ros2dds, nor are other names that "
                "begin with /%s but continue without a slash: the bridge with that namespace "
                "mistakes them for its own, and may crash. Give that bridge a namespace that no "
                "other name begins with",
                key,
                namespace,
            )

    def add_bridge(self, zid: str, prefix: str) -> None:
        """Add a bridge, and declare what passes it. The state is connected."""
        if prefix not in self._served and len(self._served) >= MAX_NAMESPACES:
            self.drops.note(Drop.BRIDGES, "bridges to DDS", str(MAX_NAMESPACES))
            return
        self.prefixes[zid] = prefix
        if prefix not in self._served:
            self._served.add(prefix)
            self.declare_all()

    def declare_all(self) -> None:
        """Declare what is not declared yet, and withdraw what a new bridge would not survive."""
        session = self.session
        if session is not None:
            for declaration in list(self._declarations):
                declaration.declare(session)

    def remove_bridge(self, zid: str) -> None:
        """Forget a bridge. Declarations stay, as a bridge that comes back expects them."""
        self.prefixes.pop(zid, None)
        self.fast_dds.discard(zid)

    def disconnect(self) -> zenoh.Session | None:
        """Undeclare everything, newest first."""
        session = super().disconnect()
        self.prefixes.clear()
        self.fast_dds.clear()
        self._served.clear()
        return session

    def _start_submessages(self, session: zenoh.Session) -> None:
        self.acknowledgements.start(session)


class BridgeDeclaration(Declaration):
    """Something that is declared once there is a bridge for its key.

    Attributes:
        endpoint: The endpoint.
    """

    endpoint: EndpointInfo

    @property
    def bridges(self) -> BridgeState:
        """The state of the connection to bridges."""
        assert isinstance(self.state, BridgeState)  # noqa: S101  # for the type checker
        return self.state

    def declare(self, session: zenoh.Session) -> None:
        """Declare it if a bridge serves its key, otherwise withdraw it; idempotent."""
        if not self.bridges.serves(bridge_key(self.endpoint.name)):
            self.undeclare()
        elif not self.is_declared:
            super().declare(session)
