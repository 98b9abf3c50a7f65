"""Acknowledgements between contexts of aionode over Zenoh: their keys, and their timer.

Zenoh's own way of losing nothing, congestion control BLOCK, holds up the whole process behind one
reader that is frozen. So reliable publishers and subscriptions of aionode acknowledge instead, on a
key of each context that ROS nodes neither hear nor send to. Who can do it announces it with a
token; readers without one are left to Zenoh (`zenoh.topics`).
"""

from __future__ import annotations

import asyncio
import logging
from typing import TYPE_CHECKING, Final, Protocol

import zenoh

from aionode.transport.zenoh._handlers import LOOP_PRIORITY, direct, reason, translated
from aionode.wire import _acknack as acknack
from aionode.wire._acknack import Submessage

if TYPE_CHECKING:
    from aionode.transport.zenoh._session_state import SessionState

__all__ = ["Acknowledgements", "Hearer", "Teller"]

logger = logging.getLogger("aionode.transport.zenoh")

PREFIX: Final = "@aionode"

TICK_S: Final = 0.05
"""How often those are looked at who wait for something."""

LIMIT: Final = 20_000
"""How many submessages wait for the loop; what is lost of them is said again."""


class Teller(Protocol):
    """A publisher, as its readers' answers see it."""

    def answer(self, said: Submessage) -> None:
        """Take an ACKNACK."""

    def tick(self) -> bool:
        """Do what it is time for; return whether to come again."""


class Hearer(Protocol):
    """A subscription, as its writers see it."""

    def told(self, said: Submessage) -> None:
        """Take what a writer says."""

    def tick(self) -> bool:
        """Do what it is time for; return whether to come again."""


class Acknowledgements:
    """What this context says of messages, and hears.

    Attributes:
        participants: The other contexts that acknowledge.
        writers: The publishers of this context that want it, by gid.
        readers: The subscriptions of this context that do it, by gid.
    """

    def __init__(self, state: SessionState) -> None:
        self.participants: set[str] = set()
        self.writers: dict[bytes, Teller] = {}
        self.readers: dict[bytes, Hearer] = {}
        self._state = state
        self._prefix = f"{PREFIX}/{state.domain_id}/"
        self._suffix = f"/reliable/{acknack.VERSION}"
        self._session: zenoh.Session | None = None
        self._declared: list[zenoh.Subscriber[None] | zenoh.LivelinessToken] = []
        self._queue = state.queue(self._take, LIMIT)
        self._tokens = state.queue(self._take_token)
        self._busy: dict[Teller | Hearer, None] = {}
        self._timer: asyncio.TimerHandle | None = None

    def start(self, session: zenoh.Session) -> None:
        """Announce and listen: before any endpoint is announced."""
        self._session = session
        liveliness = session.liveliness()
        own = self._prefix + self._state.participant + self._suffix
        with translated("acknowledgements"):
            self._declared = [
                session.declare_subscriber(own, direct(self._queue.put)),
                liveliness.declare_subscriber(
                    f"{self._prefix}*{self._suffix}", direct(self._tokens.put), history=True
                ),
                liveliness.declare_token(own),
            ]

    def stop(self) -> None:
        """Say and hear nothing more."""
        self._session = None
        declared, self._declared = self._declared, []
        for one in reversed(declared):
            one.undeclare()  # type: ignore[no-untyped-call]  # the stub leaves out the result
        self._queue.clear()
        self._tokens.clear()
        self.participants.clear()
        self._busy.clear()
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None

    def say(self, participant: str, data: bytes, priority: zenoh.Priority = LOOP_PRIORITY) -> None:
        """Send a submessage to another context; it may be lost. A large one from a thread."""
        session = self._session
        if session is None:
            return
        try:
            session.put(
                self._prefix + participant + self._suffix,
                data,
                congestion_control=zenoh.CongestionControl.DROP,
                priority=priority,
                allowed_destination=zenoh.Locality.REMOTE,
            )
        except zenoh.ZError as error:
            logger.debug("%s: not sent: %s", participant, reason(error))

    def watch(self, one: Teller | Hearer) -> None:
        """Call `one.tick` from now on, until it says that it waits for nothing more."""
        self._busy[one] = None
        if self._timer is None and self._session is not None:
            self._timer = asyncio.get_running_loop().call_later(TICK_S, self._tick)

    def _tick(self) -> None:
        self._timer = None
        for one in list(self._busy):
            if not one.tick():
                self._busy.pop(one, None)
        if self._busy and self._session is not None:
            self._timer = asyncio.get_running_loop().call_later(TICK_S, self._tick)

    def _take(self, sample: zenoh.Sample) -> None:
        said = acknack.unpack(sample.payload.to_bytes())
        if said is None:
            self._state.note_malformed(str(sample.key_expr), "an acknowledgement")
        elif said.kind is acknack.Kind.ACKNACK:
            writer = self.writers.get(said.writer)
            if writer is not None:
                writer.answer(said)
        else:
            reader = self.readers.get(said.reader)
            if reader is not None:
                reader.told(said)

    def _take_token(self, sample: zenoh.Sample) -> None:
        participant = str(sample.key_expr).removeprefix(self._prefix).removesuffix(self._suffix)
        if participant == self._state.participant:
            return
        # One that is gone is left in: its endpoints go by themselves, and it may come back.
        if sample.kind == zenoh.SampleKind.PUT and participant not in self.participants:
            self.participants.add(participant)
            for updates in list(self._state.on_reader.values()):
                for update in list(updates):
                    update()
