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
from aionode.transport._loop_waker import LoopWaker, ThreadsafeQueue
from aionode.transport._send_thread import SendThread
from aionode.transport.base import Registration
from aionode.transport.zenoh._acknowledgements import Acknowledgements
from aionode.transport.zenoh._cancellations import Cancellations
from aionode.transport.zenoh._handlers import translated
from aionode.transport.zenoh._peers import Peers
from aionode.wire._liveliness import gid_of

if TYPE_CHECKING:
    from aionode.graph import Graph

__all__ = ["FLUSH_S", "Declaration", "SessionState"]

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


class SessionState:
    """The connection of one context, open or not.

    Attributes:
        participant: Id of the context, and of its session.
        domain_id: The ROS domain.
        session: The session while it is open.
        graph: Where others are found while it is open.
        waker: The way from Zenoh's threads to the loop.
        bulk: Sends what is large.
        send_threads: Every thread that sends messages.
        peers: The ways of requests and replies.
        burst: How much the loop has just put itself.
        acknowledgements: What is said of messages between contexts of aionode.
        lingering: Publishers that were destroyed and still have something to send.
        malformed: How many samples of each key were in no known form.
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
        self.waker = LoopWaker()
        self.bulk = SendThread("aionode-bulk", self.waker)
        self.send_threads = {self.bulk}
        self.peers = Peers(self.waker)
        self.burst = Burst()
        self.acknowledgements = Acknowledgements(self)
        self.lingering: dict[Lingering, None] = {}
        self.malformed: Counter[str] = Counter()
        self.own_gids: set[bytes] = set()
        self.cancellations = Cancellations(participant, domain_id, self.waker, self.note_malformed)
        self.now_ns = MachineTime().system_ns
        self.on_reader: dict[str, list[Callable[[], None]]] = {}
        self._lingered: asyncio.Future[None] | None = None
        self._shares_from_ns = 0  # when the first large message of this session was sent
        self._declarations: dict[Declaration, None] = {}

    def queue(self, handle: Callable[[T], None], limit: int | None = None) -> ThreadsafeQueue[T]:
        """Return a queue from Zenoh's threads to `handle` on the loop."""
        return ThreadsafeQueue(self.waker, handle, limit)

    def add(self, declaration: Declaration) -> None:
        """Declare `declaration` now, or as soon as the session is open."""
        self._declarations[declaration] = None
        if self.session is not None:
            declaration.declare(self.session)

    def remove(self, declaration: Declaration) -> None:
        """Forget `declaration`."""
        self._declarations.pop(declaration, None)

    def connect(self, session: zenoh.Session, graph: Graph) -> None:
        """Declare everything in `session`."""
        self.session = session
        self.graph = graph
        self._shares_from_ns = 0
        self.acknowledgements.start(session)
        self.cancellations.start(session)
        for declaration in list(self._declarations):
            declaration.declare(session)

    def is_preparing_shared_memory(self) -> bool:
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
        for declaration in list(self._declarations):
            declaration.linger()
        with suppress(TimeoutError):
            async with asyncio.timeout(FLUSH_S):
                while self.lingering:
                    self._lingered = asyncio.get_running_loop().create_future()
                    await self._lingered
                for send_thread in list(self.send_threads):
                    if send_thread is not self.bulk:
                        await send_thread.flush()
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
            for declaration in reversed(self._declarations):
                declaration.undeclare()
            for publisher in list(self.lingering):
                publisher.finish()
        self.peers.clear()
        self.cancellations.stop()
        self.acknowledgements.stop()
        self.graph = None
        return session

    def note_malformed(self, key: str, problem: str) -> None:
        """Count a sample that is in no known form, and say so the first time."""
        self.malformed[key] += 1
        if self.malformed[key] == 1:
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


class Declaration(Registration):
    """Something that is declared in the session while that is open.

    Args:
        state: The connection.
        token: Its liveliness token; without one others do not see it.
    """

    def __init__(self, state: SessionState, token: str) -> None:
        self.state = state
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
        self.state.remove(self)
        self.undeclare()
