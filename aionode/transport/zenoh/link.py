"""What all entities of one context share: the session, the ways into the loop and out of it."""

from __future__ import annotations

import asyncio
import logging
from abc import abstractmethod
from collections import Counter
from collections.abc import Callable
from contextlib import suppress
from typing import TYPE_CHECKING, Final, Protocol, TypeVar

import zenoh

from aionode.clock import MachineTime, perf_ns
from aionode.transport.base import Announcement
from aionode.transport.sender import Sender
from aionode.transport.wakeup import Lane, Wakeup
from aionode.transport.zenoh.acknowledgements import Acknowledgements
from aionode.transport.zenoh.cancellations import Cancellations
from aionode.transport.zenoh.handlers import translated
from aionode.transport.zenoh.peers import Peers
from aionode.wire.liveliness import gid_of

if TYPE_CHECKING:
    from aionode.graph import Graph

__all__ = ["FLUSH_S", "Entity", "Link"]

T = TypeVar("T")

logger = logging.getLogger("aionode.transport.zenoh")

BURST_BYTES: Final = 256 * 1024
BURST_NS: Final = 10_000_000
"""So much in so many nanoseconds finds its way to any peer that lives: a quarter of the queue."""

FLUSH_S: Final = 2.0
"""How long `flush` waits for what has to arrive, while its readers make progress."""

BULK_FLUSH_S: Final = 0.15
"""How long `flush` waits for large messages, which may be dropped."""

SHARING_NS: Final = 500_000_000
"""How long Zenoh may take to have its shared memory ready."""


class Lingering(Protocol):
    """A publisher that was destroyed."""

    def finish(self) -> None:
        """Withdraw it now, and count what was not sent."""


class Link:
    """The connection of one context, open or not.

    Attributes:
        participant: Id of the context, and of its session.
        domain_id: The ROS domain.
        session: The session while it is open.
        graph: Where others are found while it is open.
        wakeup: The way from Zenoh's threads to the loop.
        bulk: Sends what is large.
        senders: Every thread that sends messages.
        peers: The ways of requests and replies.
        burst: How much the loop has just put itself.
        acknowledgements: What is said of messages between contexts of aionode.
        lingering: Publishers that were destroyed and still have something to send.
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
        self.peers = Peers(self.wakeup)
        self.burst = Burst()
        self.acknowledgements = Acknowledgements(self)
        self.lingering: dict[Lingering, None] = {}
        self.garbage: Counter[str] = Counter()
        self.own_gids: set[bytes] = set()
        self.cancellations = Cancellations(participant, domain_id, self.wakeup, self.note_garbage)
        self.now_ns = MachineTime().system_ns
        self.on_reader: dict[str, list[Callable[[], None]]] = {}
        self._lingered: asyncio.Future[None] | None = None
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
        self.acknowledgements.start(session)
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
        """Wait until everything that was handed over was sent, `FLUSH_S` at most.

        Destroyed publishers end that wait by themselves, when their readers make no progress.
        """
        for entity in list(self._entities):
            entity.linger()
        with suppress(TimeoutError):
            async with asyncio.timeout(FLUSH_S):
                while self.lingering:
                    self._lingered = asyncio.get_running_loop().create_future()
                    await self._lingered
                for sender in list(self.senders):
                    if sender is not self.bulk:
                        await sender.flush()
        with suppress(TimeoutError):
            async with asyncio.timeout(BULK_FLUSH_S):
                await self.bulk.flush()

    def has_lingered(self, publisher: Lingering) -> None:
        """Note that a publisher has nothing to send any more."""
        self.lingering.pop(publisher, None)
        if self._lingered is not None and not self._lingered.done():
            self._lingered.set_result(None)

    def disconnect(self) -> zenoh.Session | None:
        """Undeclare everything, the newest first; return the session, to be closed."""
        session, self.session = self.session, None
        if session is not None:
            for entity in reversed(self._entities):
                entity.undeclare()
            for publisher in list(self.lingering):
                publisher.finish()
        self.peers.clear()
        self.cancellations.stop()
        self.acknowledgements.stop()
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


class Burst:
    """How much the loop puts into Zenoh at once, which has to go through its queue in time."""

    def __init__(self) -> None:
        self._left = BURST_BYTES
        self._since_ns = 0

    def spend(self, size_bytes: int) -> bool:
        """Return whether so much more can be put now."""
        self._left -= size_bytes + 128
        if self._left < 0:
            now_ns = perf_ns()
            if now_ns - self._since_ns < BURST_NS:
                return False
            self._since_ns = now_ns
            self._left = BURST_BYTES - size_bytes
        return True


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

    def linger(self) -> None:
        """Note that this is about to end, for those who still have something to send."""

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
