"""Acknowledgements between aionode contexts over Zenoh: their keys, and their timer.

Zenoh's own reliable delivery, congestion control BLOCK, stalls the whole process because of one
frozen reader. Reliable publishers and subscriptions of aionode use acknowledgements instead, on
keys below their topic's, which ROS nodes neither subscribe nor publish to. A context that supports
them declares a token; for readers in other contexts, Zenoh is relied on (`publisher`).

A submessage only counts for endpoints of the topic on whose key it came: a process that may publish
on one topic cannot speak for another.

Contexts that can be linked, of the same user and host, are near. Links bypass the rules for topics
anyway, so near contexts use one key for all topics. The keys of topics, which every process keeps,
are declared only once there is a context that is not near.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable
from typing import TYPE_CHECKING, Final

import zenoh

from aionode._process.later import Later
from aionode._process.recent import Recent
from aionode.engine.transport.loop_waker import ThreadsafeQueue
from aionode.engine.transport.reliability.submessage import (
    VERSION,
    Submessage,
    SubmessageKind,
    unpack,
)
from aionode.engine.transport.zenoh.connections.handlers import direct, translated
from aionode.engine.transport.zenoh.delivery.control_messages import ControlSubscribers
from aionode.engine.wire._key_expression import Side, side_key

if TYPE_CHECKING:
    from aionode.engine.transport.loop_waker import LoopWaker
    from aionode.engine.transport.zenoh.delivery.control_messages import ControlMessages
    from aionode.engine.transport.zenoh.session.announced import AnnouncedLimit

__all__ = ["Acknowledgements", "submessage_key"]

PREFIX: Final = "@aionode"

TICK_S: Final = 0.05
"""The interval of `tick` for publishers and subscriptions that wait for something, in seconds."""

PROBE_S: Final = 1.0
"""The interval of `probe` for publishers that must know whether their readers answer, in
seconds."""

FAR_S: Final = 0.1
"""When a context that acknowledges, but has announced no links, counts as one without, in seconds:
it announces them first, but Zenoh does not keep the order for those that connect later."""

LIMIT: Final = 20_000
"""Number of submessages that may wait for the loop; dropped ones will be repeated."""


GONE: Final = 1_000
"""Number of contexts to remember after they left: their endpoints have separate tokens, which may
still exist, and they may come back."""

MAX_ID: Final = 32
"""Maximum length of a Zenoh session id, in characters."""


Receive = Callable[[Submessage], None]
"""Passes a submessage to an endpoint."""


class Repeater:
    """Calls functions at an interval, each until it returns False.

    Args:
        interval_s: The interval.
    """

    def __init__(self, interval_s: float) -> None:
        self._interval_s = interval_s
        self._calls: dict[Callable[[], bool], None] = {}
        self._later = Later()

    def add(self, call: Callable[[], bool]) -> None:
        """Call `call` from now on."""
        self._calls[call] = None
        self._go_on()

    def _go_on(self) -> None:
        if self._calls and not self._later.waits:
            self._later.call(self._interval_s, self._run)

    def _run(self) -> None:
        for call in list(self._calls):
            if not call():
                self._calls.pop(call, None)
        self._go_on()

    def clear(self) -> None:
        """Stop calling anything."""
        self._calls.clear()
        self._later.cancel()


class Acknowledgements:
    """The submessages that this context sends and receives.

    Args:
        participant: The id of this context.
        domain_id: The ROS domain.
        waker: Wakes the event loop from Zenoh's threads.
        note_malformed: Called with the key of a malformed sample, and what it should be.
        on_participant: Called when another context is known to acknowledge.
        announced: Limits how many contexts are kept; others count as not acknowledging.
        control_messages: Sends submessages.

    Attributes:
        participants: The other contexts that acknowledge, including the last `GONE` that left.
        present: The participants whose tokens exist.
        near: The contexts of the same user and host with links.
        far: The contexts of another user or host with links.
    """

    def __init__(
        self,
        participant: str,
        domain_id: int,
        waker: LoopWaker,
        note_malformed: Callable[[str, str], None],
        on_participant: Callable[[str], None],
        announced: AnnouncedLimit,
        control_messages: ControlMessages,
    ) -> None:
        self.participants: set[str] = set()
        self._gone: Recent[str, str] = Recent(GONE)
        self._announced = announced
        self.present: set[str] = set()
        self.near: set[str] = set()
        self.far: set[str] = set()
        self._has_links = False
        # By gid, below the key of their topic: a submessage counts for no endpoint of another
        # topic.
        self._writers: ControlSubscribers[Receive] = ControlSubscribers(
            waker, self._receive_acknack, LIMIT
        )
        self._readers: ControlSubscribers[Receive] = ControlSubscribers(
            waker, self._receive_submessage, LIMIT
        )
        self._participant = participant
        self._note_malformed = note_malformed
        self._on_participant = on_participant
        self._control_messages = control_messages
        self._prefix = f"{PREFIX}/{domain_id}/"
        self._suffix = f"/reliable/{VERSION}"
        self._near_queue = ThreadsafeQueue(waker, self._receive_from_near, LIMIT)
        # The endpoints of all topics, by gid: those to which each side of a topic sends.
        self._near_endpoints: dict[Side, dict[bytes, Receive]] = {side: {} for side in Side}
        self._far_check = Later()
        self._listens_to_far = False
        self._session: zenoh.Session | None = None
        self._declared: list[zenoh.Subscriber[None] | zenoh.LivelinessToken] = []
        self._tokens: ThreadsafeQueue[zenoh.Sample] = ThreadsafeQueue(waker, self._receive_token)
        self._ticks = Repeater(TICK_S)
        self._probes = Repeater(PROBE_S)

    def start(self, session: zenoh.Session) -> None:
        """Declare the token. Must be called before any endpoint is declared."""
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

    def listen(self, *, has_links: bool) -> None:
        """Subscribe to submessages, after `start`.

        Args:
            has_links: Whether this context can be linked with others; if so, the keys of topics
                wait for one that is not near.
        """
        if self._session is None:
            return
        self._has_links = has_links
        if not has_links:
            self._listen_to_far()
            return
        key = self._near_key(self._participant)
        with translated(key):
            self._declared.append(
                self._session.declare_subscriber(
                    key, direct(self._near_queue.put), allowed_origin=zenoh.Locality.REMOTE
                )
            )

    def _listen_to_far(self) -> None:
        if self._session is not None and not self._listens_to_far:
            self._listens_to_far = True
            self._writers.start(self._session)
            self._readers.start(self._session)

    def stop(self) -> None:
        """Undeclare everything."""
        self._session = None
        self._listens_to_far = False
        self._far_check.cancel()
        self._writers.stop()
        self._readers.stop()
        declared, self._declared = self._declared, []
        for declaration in reversed(declared):
            declaration.undeclare()  # type: ignore[no-untyped-call]  # the stub leaves out the result
        self._tokens.clear()
        self._near_queue.clear()
        self.participants.clear()
        self.present.clear()
        self.near.clear()
        self.far.clear()
        self._gone.clear()
        self._ticks.clear()
        self._probes.clear()

    def tokens(self) -> set[str]:
        """Return the tokens of this context and of those that are present."""
        return {self.token_of(participant) for participant in (self._participant, *self.present)}

    def token_of(self, participant: str) -> str:
        """Return the token of a context that acknowledges."""
        return self._prefix + participant + self._suffix

    def add_writer(self, key: str, gid: bytes, receive: Receive) -> None:
        """Pass the ACKNACKs of its readers to a publisher; idempotent."""
        self._near_endpoints[Side.SUBSCRIPTIONS][gid] = receive
        self._writers.listen(
            submessage_key(key, Side.SUBSCRIPTIONS, self._participant), gid, receive
        )

    def remove_writer(self, key: str, gid: bytes) -> None:
        """Stop passing ACKNACKs to a publisher."""
        self._near_endpoints[Side.SUBSCRIPTIONS].pop(gid, None)
        self._writers.unlisten(submessage_key(key, Side.SUBSCRIPTIONS, self._participant), gid)

    def add_reader(self, key: str, gid: bytes, receive: Receive) -> None:
        """Pass the submessages of its writers to a subscription; idempotent."""
        self._near_endpoints[Side.PUBLISHERS][gid] = receive
        self._readers.listen(submessage_key(key, Side.PUBLISHERS, self._participant), gid, receive)

    def remove_reader(self, key: str, gid: bytes) -> None:
        """Stop passing submessages to a subscription."""
        self._near_endpoints[Side.PUBLISHERS].pop(gid, None)
        self._readers.unlisten(submessage_key(key, Side.PUBLISHERS, self._participant), gid)

    def send(self, key: str, side: Side, participant: str, data: bytes) -> None:
        """Send a submessage to a context; it may be lost. Any thread may call it.

        Args:
            key: The key of the topic.
            side: The side of the topic that sends it.
            participant: The context that receives it.
            data: The submessage.
        """
        is_near = participant in self.near
        if not is_near:
            self._control_messages.put(submessage_key(key, side, participant), data)
        # A context whose announcement of links was lost may listen for near ones only.
        if is_near or (self._has_links and participant not in self.far):
            self._control_messages.put(self._near_key(participant), data)

    def _near_key(self, participant: str) -> str:
        return f"{self._prefix}{participant}/near"

    def note_links(self, participant: str, *, is_near: bool, present: bool) -> None:
        """Record that another context announces links, or does not any more."""
        if present and is_near:
            self.near.add(participant)
            if self.present <= self.near:
                self._far_check.cancel()
        elif present:
            self.far.add(participant)
            self._listen_to_far()
        elif participant not in self.present:  # otherwise it is about to go, or to come back
            self.near.discard(participant)
            self.far.discard(participant)

    def watch(self, tick: Callable[[], bool]) -> None:
        """Call `tick` of an endpoint that waits for something, until it returns False."""
        if self._session is not None:
            self._ticks.add(tick)

    def probe(self, probe: Callable[[], bool]) -> None:
        """Call `probe` of a publisher from now on, until it returns False."""
        if self._session is not None:
            self._probes.add(probe)

    def _receive_acknack(self, sample: zenoh.Sample, writers: dict[Hashable, Receive]) -> None:
        submessage = self._unpack(sample)
        if submessage is not None and submessage.kind is SubmessageKind.ACKNACK:
            receive = writers.get(submessage.writer)
            if receive is not None:
                receive(submessage)

    def _receive_submessage(self, sample: zenoh.Sample, readers: dict[Hashable, Receive]) -> None:
        submessage = self._unpack(sample)
        if submessage is not None and submessage.kind is not SubmessageKind.ACKNACK:
            receive = readers.get(submessage.reader)
            if receive is not None:
                receive(submessage)

    def _receive_from_near(self, sample: zenoh.Sample) -> None:
        submessage = self._unpack(sample)
        if submessage is None:
            return
        is_acknack = submessage.kind is SubmessageKind.ACKNACK
        side = Side.SUBSCRIPTIONS if is_acknack else Side.PUBLISHERS
        gid = submessage.writer if is_acknack else submessage.reader
        receive = self._near_endpoints[side].get(gid)
        if receive is not None:
            receive(submessage)

    def _unpack(self, sample: zenoh.Sample) -> Submessage | None:
        submessage = unpack(sample.payload.to_bytes())
        if submessage is None:
            self._note_malformed(str(sample.key_expr), "an acknowledgement")
        return submessage

    def _receive_token(self, sample: zenoh.Sample) -> None:
        key = str(sample.key_expr)
        participant = key.removeprefix(self._prefix).removesuffix(self._suffix)
        if participant == self._participant or len(participant) > MAX_ID:
            return
        if sample.kind != zenoh.SampleKind.DELETE:
            self._note_present(participant, key)
        elif participant in self.present:
            self.present.discard(participant)
            self._announced.release(participant, key)
            oldest = self._gone.put(participant, participant)
            if oldest is not None:
                self.participants.discard(oldest)
                self.near.discard(oldest)
                self.far.discard(oldest)

    def _note_present(self, participant: str, key: str) -> None:
        if participant in self.present or not self._announced.admit(participant, key):
            return
        self.present.add(participant)
        self._gone.pop(participant, None)
        if participant not in self.participants:
            self.participants.add(participant)
            self._on_participant(participant)
        if participant in self.near or self._session is None:
            return
        if not (self._listens_to_far or self._far_check.waits):
            self._far_check.call(FAR_S, self._check_far)

    def _check_far(self) -> None:
        if self.present - self.near:
            self._listen_to_far()


def submessage_key(key: str, side: Side, participant: str) -> str:
    """Return the key of submessages to one context.

    Args:
        key: The key of the topic.
        side: The side that sends them: subscriptions send ACKNACK, publishers everything else.
        participant: The context that receives them.
    """
    # One chunk for all three: every process keeps each chunk of each key, in 0.6 kB.
    return side_key(key, side, f"reliable.{VERSION}.{participant}")
