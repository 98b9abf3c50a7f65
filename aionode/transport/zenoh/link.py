"""What all entities of one context share: the session, the ways into the loop and out of it."""

from __future__ import annotations

import logging
from abc import abstractmethod
from collections import Counter
from collections.abc import Callable
from typing import TYPE_CHECKING, Final, TypeVar

import zenoh

from aionode.clock import MachineTime, perf_ns
from aionode.transport.base import Announcement
from aionode.transport.sender import Sender
from aionode.transport.wakeup import Lane, Wakeup
from aionode.transport.zenoh.cancellations import Cancellations
from aionode.transport.zenoh.handlers import translated
from aionode.wire.liveliness import gid_of

if TYPE_CHECKING:
    from aionode.graph import Graph

__all__ = ["Entity", "Link"]

T = TypeVar("T")

logger = logging.getLogger("aionode.transport.zenoh")

SHARING_NS: Final = 500_000_000
"""How long Zenoh may take to have its shared memory ready."""


class Link:
    """The connection of one context, open or not.

    Attributes:
        participant: Id of the context, and of its session.
        domain_id: The ROS domain.
        session: The session while it is open.
        graph: Where others are found while it is open.
        wakeup: The way from Zenoh's threads to the loop.
        bulk: Sends what is large.
        senders: Every thread that sends.
        garbage: How many samples of each key were in no known form.
        own_gids: Ids of this context's publishers.
        cancellations: Requests that clients have given up.
        now_ns: The system time, in nanoseconds since 1970.
        on_reader: What is told of each remote subscription that comes or goes, by topic.
    """

    def __init__(self, participant: str, domain_id: int) -> None:
        self.participant = participant
        self.domain_id = domain_id
        self.session: zenoh.Session | None = None
        self.graph: Graph | None = None
        self.wakeup = Wakeup()
        self.bulk = Sender("aionode-bulk", self.wakeup)
        self.senders = {self.bulk}
        self.garbage: Counter[str] = Counter()
        self.own_gids: set[bytes] = set()
        self.cancellations = Cancellations(participant, domain_id, self.wakeup, self.note_garbage)
        self.now_ns = MachineTime().system_ns
        self.on_reader: dict[str, list[Callable[[], None]]] = {}
        self._shares_from_ns = 0  # when the first large message of this session was sent
        self._entities: dict[Entity, None] = {}

    def lane(self, handle: Callable[[T], None], limit: int | None = None) -> Lane[T]:
        """Return a queue from Zenoh's threads to `handle` on the loop."""
        return Lane(self.wakeup, handle, limit)

    def add(self, entity: Entity) -> None:
        """Declare `entity` now, or as soon as the session is open."""
        self._entities[entity] = None
        if self.session is not None:
            entity.declare(self.session)

    def remove(self, entity: Entity) -> None:
        """Forget `entity`."""
        self._entities.pop(entity, None)

    def connect(self, session: zenoh.Session, graph: Graph) -> None:
        """Declare everything in `session`."""
        self.session = session
        self.graph = graph
        self._shares_from_ns = 0
        self.cancellations.start(session)
        for entity in list(self._entities):
            entity.declare(session)

    def begins_to_share(self) -> bool:
        """Whether Zenoh may be busy making its shared memory. For the thread that sends bulk.

        It does so with the first large message, which takes some 20 ms, and this message still goes
        through the network: fragment by fragment, of which each is dropped after a millisecond or
        two of waiting, with the whole message (zenoh 1.10).
        """
        now_ns = perf_ns()
        self._shares_from_ns = self._shares_from_ns or now_ns
        return now_ns - self._shares_from_ns < SHARING_NS

    async def flush(self) -> None:
        """Wait until everything that was handed to the threads was sent, and let them end."""
        for sender in list(self.senders):
            await sender.flush()

    def disconnect(self) -> zenoh.Session | None:
        """Undeclare everything, the newest first; return the session, to be closed."""
        session, self.session = self.session, None
        if session is not None:
            for entity in reversed(self._entities):
                entity.undeclare()
        self.cancellations.stop()
        self.graph = None
        return session

    def note_garbage(self, key: str, problem: str) -> None:
        """Count a sample that is in no known form, and say so the first time."""
        self.garbage[key] += 1
        if self.garbage[key] == 1:
            logger.warning(
                "%s: something in an unknown form came from the network: %s; it was left out, and "
                "more of it is only counted. Does the sender have another definition of the type?",
                key,
                problem,
            )


class Entity(Announcement):
    """Something that is declared in the session while that is open.

    Args:
        link: The connection.
        token: Its liveliness token; without one others do not see it.
    """

    def __init__(self, link: Link, token: str) -> None:
        self.link = link
        self.token = token
        self.gid = gid_of(token)
        self._declared = False
        self._declared_token: zenoh.LivelinessToken | None = None

    def __hash__(self) -> int:
        return id(self)

    def declare(self, session: zenoh.Session) -> None:
        """Announce it: first what it does, then, to everybody, that it is there."""
        with translated(self.token):
            self.declare_data(session)
            self._declared = True
            if self.token:
                self._declared_token = session.liveliness().declare_token(self.token)

    def undeclare(self) -> None:
        """Withdraw it, in the other order."""
        token, self._declared_token = self._declared_token, None
        declared, self._declared = self._declared, False
        with translated(self.token):
            if token is not None:
                token.undeclare()
            if declared:
                self.undeclare_data()

    @abstractmethod
    def declare_data(self, session: zenoh.Session) -> None:
        """Declare what it does."""

    @abstractmethod
    def undeclare_data(self) -> None:
        """Withdraw what it does."""

    def close(self) -> None:
        """Withdraw it for good; twice is the same as once."""
        self.link.remove(self)
        self.undeclare()
