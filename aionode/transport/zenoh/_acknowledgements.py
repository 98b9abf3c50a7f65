"""Acknowledgements between contexts of aionode over Zenoh: their keys, and their timer.

Zenoh's own reliable delivery, congestion control BLOCK, stalls the whole process behind one frozen
reader. Reliable publishers and subscriptions of aionode use acknowledgements instead, on keys below
that of their topic, which ROS nodes neither subscribe nor publish to. A context that supports them
declares a token; readers in other contexts depend on Zenoh (`_publisher`).

A submessage counts only for endpoints of the topic on whose key it came: a process that may publish
on one topic speaks for no other.
"""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Final, Protocol

import zenoh

from aionode.transport._loop_waker import ThreadsafeQueue
from aionode.transport.zenoh._handlers import LOOP_PRIORITY, direct, reason, translated
from aionode.wire import _acknack as acknack
from aionode.wire._acknack import Submessage, SubmessageKind
from aionode.wire._key_expression import Side

if TYPE_CHECKING:
    from aionode.transport._loop_waker import LoopWaker
    from aionode.transport.zenoh._announced import AnnouncedLimit
    from aionode.transport.zenoh._outlet import Outlet

__all__ = ["Acknowledgements", "StatefulReader", "StatefulWriter"]

logger = logging.getLogger("aionode.transport.zenoh")

PREFIX: Final = "@aionode"

TICK_S: Final = 0.05
"""The interval of `tick` for publishers and subscriptions that wait for something."""

PROBE_S: Final = 1.0
"""The interval of `probe` for publishers that have to know whether their readers answer."""

LIMIT: Final = 20_000
"""Number of submessages that wait for the loop; those that are dropped are repeated."""


GONE: Final = 1_000
"""Contexts that have gone and are remembered: their endpoints have tokens of their own, which
may still be there, and they may come back."""

LONGEST_ID: Final = 32
"""Number of characters that the id of a Zenoh session has at most."""


class StatefulWriter(Protocol):
    """A publisher that keeps messages until they are acknowledged."""

    def take_acknack(self, submessage: Submessage) -> None:
        """Handle an ACKNACK of one of its readers."""

    def tick(self) -> bool:
        """Do what is due; return whether to call again."""

    def probe(self) -> bool:
        """Ask readers for an answer; return whether to call again."""


class StatefulReader(Protocol):
    """A subscription that acknowledges messages."""

    def take_submessage(self, submessage: Submessage) -> None:
        """Handle a HEARTBEAT, GAP or DATA of one of its writers."""

    def tick(self) -> bool:
        """Do what is due; return whether to call again."""


class Listening:
    """A subscriber for what one side of a topic tells this context.

    Attributes:
        key: That of the topic.
        side: Who tells it.
        subscriber: The subscriber.
        users: How many endpoints need it.
    """

    def __init__(self, key: str, side: Side, subscriber: zenoh.Subscriber[None]) -> None:
        self.key = key
        self.side = side
        self.subscriber = subscriber
        self.users = 1


class Repeater:
    """Calls functions at an interval, each until it returns False.

    Args:
        interval_s: The interval.
    """

    def __init__(self, interval_s: float) -> None:
        self._interval_s = interval_s
        self._calls: dict[Callable[[], bool], None] = {}
        self._timer: asyncio.TimerHandle | None = None

    def add(self, call: Callable[[], bool]) -> None:
        """Call `call` from now on."""
        self._calls[call] = None
        self._go_on()

    def _go_on(self) -> None:
        if self._calls and self._timer is None:
            self._timer = asyncio.get_running_loop().call_later(self._interval_s, self._run)

    def _run(self) -> None:
        self._timer = None
        for call in list(self._calls):
            if not call():
                self._calls.pop(call, None)
        self._go_on()

    def clear(self) -> None:
        """Call nothing any more."""
        self._calls.clear()
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None


class Acknowledgements:
    """The submessages that this context sends and receives.

    Args:
        participant: The id of this context.
        domain_id: The ROS domain.
        waker: Wakes the event loop from Zenoh's threads.
        note_malformed: Called with the key of a malformed sample, and what it should be.
        on_participant: Called when another context is known to acknowledge.
        announced: Limits how many contexts are kept; the others count as ones that do not.
        outlet: Where submessages are put.

    Attributes:
        participants: The other contexts that acknowledge, the last `GONE` that have gone included.
        present: Those of them whose tokens are there.
        writers: The publishers of this context that want acknowledgements, by key and gid.
        readers: The subscriptions of this context that acknowledge, by key and gid.
    """

    def __init__(
        self,
        participant: str,
        domain_id: int,
        waker: LoopWaker,
        note_malformed: Callable[[str, str], None],
        on_participant: Callable[[str], None],
        announced: AnnouncedLimit,
        outlet: Outlet,
    ) -> None:
        self.participants: set[str] = set()
        self._gone: dict[str, None] = {}  # in order
        self._announced = announced
        self.present: set[str] = set()
        self.writers: dict[tuple[str, bytes], StatefulWriter] = {}
        self.readers: dict[tuple[str, bytes], StatefulReader] = {}
        # The subscriptions, by the whole key.
        self._listening: dict[str, Listening] = {}
        self._participant = participant
        self._note_malformed = note_malformed
        self._on_participant = on_participant
        self._outlet = outlet
        self._prefix = f"{PREFIX}/{domain_id}/"
        self._suffix = f"/reliable/{acknack.VERSION}"
        self._session: zenoh.Session | None = None
        self._declared: list[zenoh.Subscriber[None] | zenoh.LivelinessToken] = []
        self._queue: ThreadsafeQueue[zenoh.Sample] = ThreadsafeQueue(waker, self._take, LIMIT)
        self._tokens: ThreadsafeQueue[zenoh.Sample] = ThreadsafeQueue(waker, self._take_token)
        self._ticks = Repeater(TICK_S)
        self._probes = Repeater(PROBE_S)

    def start(self, session: zenoh.Session) -> None:
        """Declare the token. To be called before any endpoint is declared."""
        self._session = session
        liveliness = session.liveliness()
        own = self.token_of(self._participant)
        with translated("acknowledgements"):
            self._declared = [
                liveliness.declare_subscriber(
                    self.token_of("*"), direct(self._tokens.put), history=True
                ),
                liveliness.declare_token(own),
            ]

    def stop(self) -> None:
        """Undeclare everything."""
        self._session = None
        declared, self._declared = self._declared, []
        declared += [each.subscriber for each in self._listening.values()]
        self._listening.clear()
        for declaration in reversed(declared):
            declaration.undeclare()  # type: ignore[no-untyped-call]  # the stub leaves out the result
        self._queue.clear()
        self._tokens.clear()
        self.participants.clear()
        self.present.clear()
        self._gone.clear()
        self._ticks.clear()
        self._probes.clear()

    def tokens(self) -> set[str]:
        """Return the tokens of this context and of those that are present."""
        return {self.token_of(each) for each in (self._participant, *self.present)}

    def token_of(self, participant: str) -> str:
        """Return the token of a context that acknowledges."""
        return self._prefix + participant + self._suffix

    def listen(self, key: str, side: Side) -> None:
        """Hear what one side of a topic tells this context, until `unlisten` was called as often.

        One subscriber for each topic, as a rule for one topic would refuse one for all of them.
        """
        session, whole_key = self._session, acknack.submessage_key(key, side, self._participant)
        listening = self._listening.get(whole_key)
        if listening is not None:
            listening.users += 1
        elif session is not None:
            with translated(key):
                subscriber = session.declare_subscriber(whole_key, direct(self._queue.put))
            self._listening[whole_key] = Listening(key, side, subscriber)

    def unlisten(self, key: str, side: Side) -> None:
        """Hear it no more, unless another endpoint does."""
        whole_key = acknack.submessage_key(key, side, self._participant)
        listening = self._listening.get(whole_key)
        if listening is not None:
            listening.users -= 1
            if not listening.users:
                del self._listening[whole_key]
                listening.subscriber.undeclare()

    def send(self, key: str, data: bytes, priority: zenoh.Priority = LOOP_PRIORITY) -> None:
        """Send a submessage; it may be lost. Large ones go from a thread."""
        if self._outlet.is_crowded:
            self._outlet.send(partial(self.send_now, key, data, priority), len(data))
        else:
            self.send_now(key, data, priority)

    def send_now(self, key: str, data: bytes, priority: zenoh.Priority = LOOP_PRIORITY) -> None:
        """Send a submessage from the calling thread."""
        session = self._session
        if session is None:
            return
        try:
            session.put(
                key,
                data,
                congestion_control=zenoh.CongestionControl.DROP,
                priority=priority,
                allowed_destination=zenoh.Locality.REMOTE,
            )
        except zenoh.ZError as error:
            logger.debug("%s: not sent: %s", key, reason(error))

    def watch(self, endpoint: StatefulWriter | StatefulReader) -> None:
        """Call `endpoint.tick` from now on until it returns False."""
        if self._session is not None:
            self._ticks.add(endpoint.tick)

    def probe(self, writer: StatefulWriter) -> None:
        """Call `writer.probe` from now on until it returns False."""
        if self._session is not None:
            self._probes.add(writer.probe)

    def _take(self, sample: zenoh.Sample) -> None:
        whole_key = str(sample.key_expr)
        listening = self._listening.get(whole_key)
        if listening is None:  # its last endpoint was just closed
            return
        submessage = acknack.unpack(sample.payload.to_bytes())
        if submessage is None:
            self._note_malformed(whole_key, "an acknowledgement")
        elif submessage.kind is SubmessageKind.ACKNACK:
            writer = self.writers.get((listening.key, submessage.writer))
            if writer is not None and listening.side is Side.SUBSCRIPTIONS:
                writer.take_acknack(submessage)
        else:
            reader = self.readers.get((listening.key, submessage.reader))
            if reader is not None and listening.side is Side.PUBLISHERS:
                reader.take_submessage(submessage)

    def _take_token(self, sample: zenoh.Sample) -> None:
        key = str(sample.key_expr)
        participant = key.removeprefix(self._prefix).removesuffix(self._suffix)
        if participant == self._participant or len(participant) > LONGEST_ID:
            return
        if sample.kind != zenoh.SampleKind.DELETE:
            self._note_present(participant, key)
        elif participant in self.present:
            self.present.discard(participant)
            self._announced.give_back(participant, key)
            self._gone[participant] = None
            if len(self._gone) > GONE:
                oldest = next(iter(self._gone))
                del self._gone[oldest]
                self.participants.discard(oldest)

    def _note_present(self, participant: str, key: str) -> None:
        if participant in self.present or not self._announced.take(participant, key):
            return
        self.present.add(participant)
        self._gone.pop(participant, None)
        if participant not in self.participants:
            self.participants.add(participant)
            self._on_participant(participant)
