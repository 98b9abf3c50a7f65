"""A subscription switches routes in mid-stream: each message arrives once and in order."""

from __future__ import annotations

from collections import deque
from typing import TYPE_CHECKING, Any, cast

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from aionode.engine.transport.link._protocol import Frame, Kind
from aionode.engine.transport.link._subscription import MAX_HELD, LinkReader, RemotePublisher, Route
from aionode.graph import EndpointInfo, EndpointKind, NodeInfo
from aionode.interfaces.std_msgs.msg import Int32
from aionode.qos import QoSProfile
from tests.support.peers import KEEP_ALL

if TYPE_CHECKING:
    from collections.abc import Callable

GID = b"publisher".ljust(16)


def endpoint(kind: EndpointKind, gid: bytes, profile: QoSProfile) -> EndpointInfo:
    """Return one of the two endpoints, each in its own context."""
    node = NodeInfo(gid.hex(), 1, "node", "/")
    return EndpointInfo(kind, node, 1, "/n", "std_msgs/msg/Int32", "hash", profile, gid)


class Registry:
    """The links of a context without any link; time advances only when the test says so."""

    def __init__(self) -> None:
        self.timers: list[Callable[[], None]] = []

    def now_ns(self) -> int:
        """Return the time of arrival, which does not matter here."""
        return 1

    def later(self, _: float, call: Callable[[], None]) -> None:
        """Keep `call` for `HandedOver.let_time_pass`."""
        self.timers.append(call)


class Local:
    """The subscription itself, which records the numbers delivered."""

    def __init__(self, got: list[int], profile: QoSProfile) -> None:
        self.endpoint = endpoint(EndpointKind.SUBSCRIPTION, b"subscription".ljust(16), profile)
        self.raw = True
        self._got = got

    def deliver(self, msg: bytes, *_: object) -> None:
        """Record a message, whose payload is its number."""
        self._got.append(int.from_bytes(msg))

    def reject(self, error: Exception) -> None:
        """Fail: every message can be decoded."""
        raise error

    def note_alive(self, gid: bytes) -> None:
        """Do nothing: publishers here do not assert liveliness."""

    @property
    def waiting(self) -> int:
        """Return 0: nothing waits."""
        return 0

    def has_room(self) -> bool:
        """Return True: there is always room."""
        return True

    async def wait_for_room(self) -> None:
        """Return at once: there is always room."""

    def when_room(self, callback: Callable[[], None]) -> None:
        """Call back at once: there is always room."""


class HandedOver:
    """The subscription's view of one remote publisher, with messages that are their numbers."""

    def __init__(self, got: list[int], profile: QoSProfile | None = None) -> None:
        profile = QoSProfile(depth=10) if profile is None else profile
        self.registry = Registry()
        links = cast(Any, self.registry)
        self.reader = LinkReader(links, Int32, Local(got, profile))
        publisher = endpoint(EndpointKind.PUBLISHER, GID, profile)
        self.remote = RemotePublisher(links, self.reader, publisher)
        self.reader.remote_publishers[GID] = self.remote
        self.opened = self.remote.opened
        self.broken = self.remote.broken
        self.gone = self.remote.gone
        self.retransmit_done = self.remote.retransmit_done
        self.stop_waiting = self.remote.stop_waiting

    @property
    def route(self) -> Route:
        """The route over which messages come."""
        return self.remote.route

    @property
    def last(self) -> int:
        """The number delivered last."""
        return self.remote.last

    @property
    def waits(self) -> bool:
        """Whether messages are being held."""
        return self.remote.waits

    def from_zenoh(self, number: int) -> None:
        """Deliver a message over Zenoh."""
        self.reader.deliver(number.to_bytes(8), GID, number, 0)

    def from_link(self, number: int) -> None:
        """Deliver a message over the link."""
        self.remote.from_link(number.to_bytes(8), number, 0, 0)

    def from_retransmit(self, number: int) -> None:
        """Deliver a retransmitted message."""
        self.remote.from_other_route(number.to_bytes(8), Frame(Kind.DATA, number, 0, GID))

    def from_other_loop(self, number: int) -> None:
        """Deliver the stop of a lease past the link."""
        self.remote.from_other_route(number.to_bytes(8), Frame(Kind.STOP, number, 0, GID))

    def let_time_pass(self) -> None:
        """Run the timers set so far."""
        timers, self.registry.timers = self.registry.timers, []
        for call in timers:
            call()


class Stream:
    """A publisher, three routes that each preserve order, and a subscription at the other end."""

    def __init__(self) -> None:
        self.published = 0
        self.got: list[int] = []
        self.handover = HandedOver(self.got)
        self.zenoh: deque[int] = deque()
        self.retransmit: deque[tuple[str, int]] = deque()
        self.link: deque[tuple[str, int]] = deque()
        self._linked = False
        self._needs_zenoh = True
        self._unconfirmed: list[int] = []

    def publish(self) -> None:
        """Send one message, as a linked publisher does."""
        self.published += 1
        if self._linked:
            self.link.append(("data", self.published))
            self._unconfirmed.append(self.published)
        if self._needs_zenoh:
            self.zenoh.append(self.published)

    def open(self) -> None:
        """Open the link, once the leftovers of the last one have been retransmitted."""
        if not self._linked and not self.link and not self.retransmit:
            self._linked = True
            self.link.append(("opened", self.published))

    def hear_unannounced(self) -> None:
        """From now on publish over both routes, for an unannounced subscription."""
        self._needs_zenoh = True

    def lose_unannounced(self) -> None:
        """Publish over the link only, if the subscription has accepted it."""
        self._needs_zenoh = not (self._linked and self.handover.route is Route.LINK)

    def confirm(self) -> None:
        """Confirm what has been delivered."""
        if self._linked and self.handover.route is Route.LINK:
            self._unconfirmed = [n for n in self._unconfirmed if n > self.handover.last]

    def take_zenoh(self) -> None:
        """Deliver one message over Zenoh."""
        if self.zenoh:
            number = self.zenoh.popleft()
            self.handover.from_zenoh(number)
            self.lose_unannounced()

    def take_retransmitted(self) -> None:
        """Deliver one retransmitted message, which comes after the link and its end."""
        while self.link and self.retransmit:
            self.take_link()
        if self.retransmit:
            what, number = self.retransmit.popleft()
            if what == "done":
                self.handover.retransmit_done()
            else:
                self.handover.from_retransmit(number)

    def take_link(self) -> None:
        """Deliver one frame over the link."""
        if self.link:
            what, number = self.link.popleft()
            if what == "end":
                self.handover.broken()
            elif what == "opened":
                self.handover.opened(number)
            else:
                self.handover.from_link(number)
            self.lose_unannounced()

    def end_link(self) -> None:
        """Break the link: frames in transit may be lost and are retransmitted."""
        if self._linked:
            self._linked = False
            self._needs_zenoh = True
            self.link.append(("end", 0))
            self.retransmit.extend(("data", number) for number in self._unconfirmed)
            self.retransmit.append(("done", 0))
            self._unconfirmed.clear()

    def lose_what_is_on_its_way(self) -> None:
        """Break the link, and lose all frames in transit."""
        if self._linked:
            self.link.clear()
            self.end_link()

    def finish(self) -> None:
        """Deliver everything, plus one more message to end a hand-over."""
        self.publish()
        for take, route in (
            (self.take_zenoh, self.zenoh),
            (self.take_link, self.link),
            (self.take_zenoh, self.zenoh),
            (self.take_retransmitted, self.retransmit),
        ):
            while route:
                take()


STEPS: list[Callable[[Stream], None]] = [
    Stream.publish,
    Stream.publish,
    Stream.open,
    Stream.confirm,
    Stream.hear_unannounced,
    Stream.lose_unannounced,
    Stream.take_zenoh,
    Stream.take_retransmitted,
    Stream.take_link,
    Stream.end_link,
    Stream.lose_what_is_on_its_way,
]


@given(st.lists(st.sampled_from(STEPS), max_size=80))
@settings(max_examples=settings().max_examples * 6)
def test_each_message_comes_once_and_in_order_whatever_the_routes_do(
    steps: list[Callable[[Stream], None]],
) -> None:
    """Links come up and go down at any point of a stream, and any route may be the slower one."""
    stream = Stream()
    for step in steps:
        step(stream)
    stream.finish()
    assert stream.got == list(range(1, stream.published + 1))


def test_a_publisher_that_has_sent_nothing_is_taken_from_the_link_at_once() -> None:
    """There is no reason for its first message to wait for Zenoh."""
    handover = HandedOver([])
    handover.opened(0)
    assert handover.route is Route.LINK


def test_the_last_message_before_the_link_shows_that_nothing_is_under_way() -> None:
    """Then there is no need to wait for the next one."""
    got: list[int] = []
    handover = HandedOver(got)
    handover.opened(5)
    handover.from_zenoh(5)
    assert handover.route is Route.LINK
    handover.from_link(6)
    assert got == [5, 6]


def test_what_is_held_comes_out_when_zenoh_stays_silent() -> None:
    """Zenoh may have lost the message, or never have had it."""
    got: list[int] = []
    handover = HandedOver(got)
    handover.opened(5)
    handover.from_link(6)
    assert handover.waits
    handover.stop_waiting()
    assert handover.route is Route.LINK
    handover.from_zenoh(6)
    assert got == [6]


def test_the_number_of_held_messages_is_bounded() -> None:
    """Memory stays bounded, whatever Zenoh does."""
    got: list[int] = []
    handover = HandedOver(got)
    handover.opened(1)
    for number in range(2, MAX_HELD + 1):
        handover.from_link(number)
    assert got == []
    handover.from_link(MAX_HELD + 1)
    assert handover.route is Route.LINK
    assert got == list(range(2, MAX_HELD + 2))


def test_copies_that_zenoh_brings_ahead_of_the_link_are_bounded() -> None:
    """All of them also come over the link, or are retransmitted when it ends."""
    got: list[int] = []
    handover = HandedOver(got)
    handover.opened(0)
    for number in range(1, MAX_HELD + 100):
        handover.from_zenoh(number)
    handover.broken()
    for number in range(1, 100):
        handover.from_retransmit(number)
    assert got == list(range(1, MAX_HELD + 100))


def test_after_a_link_has_ended_what_came_over_it_does_not_come_again() -> None:
    """Zenoh may still deliver a copy from the time when both routes were in use."""
    got: list[int] = []
    handover = HandedOver(got)
    handover.opened(0)
    for number in (1, 2):
        handover.from_link(number)
    handover.broken()
    for number in (2, 3):
        handover.from_zenoh(number)
    assert got == [1, 2, 3]


def test_what_was_lost_for_good_is_waited_for_only_until_it_is_given_up() -> None:
    """The publisher may have been killed before it could retransmit anything."""
    got: list[int] = []
    handover = HandedOver(got)
    handover.opened(0)
    handover.from_link(1)
    handover.broken()
    handover.from_zenoh(3)
    assert handover.waits
    assert got == [1]
    handover.stop_waiting()
    assert handover.route is Route.ZENOH
    assert got == [1, 3]


def test_what_comes_over_a_link_for_another_reader_is_left_to_zenoh() -> None:
    """Before the link is opened, older messages may still be in transit over Zenoh."""
    got: list[int] = []
    handover = HandedOver(got)
    handover.from_link(7)
    handover.from_zenoh(6)
    assert got == [6]


def test_what_zenoh_still_brings_when_a_publisher_has_gone_is_delivered() -> None:
    """The link came up in the middle of a burst, and its last frame overtakes the whole burst."""
    got: list[int] = []
    handover = HandedOver(got)
    for number in range(1, 4):
        handover.from_zenoh(number)
    handover.opened(10)
    handover.from_link(11)
    handover.gone()
    for number in range(4, 12):
        handover.from_zenoh(number)
        handover.let_time_pass()
    assert got == list(range(1, 12))


def test_copies_that_zenoh_brings_after_a_publisher_has_gone_are_dropped() -> None:
    """They were delivered twice; the publisher is forgotten only when nothing comes any more."""
    got: list[int] = []
    handover = HandedOver(got)
    handover.opened(0)
    for number in range(1, 6):
        handover.from_link(number)
    handover.gone()
    for number in range(1, 6):
        handover.from_zenoh(number)
        handover.let_time_pass()
    assert got == [1, 2, 3, 4, 5]
    handover.let_time_pass()
    assert not handover.reader.remote_publishers


def test_the_wait_for_messages_of_a_gone_publisher_that_zenoh_has_lost_is_limited() -> None:
    """What the link has brought is delivered then."""
    got: list[int] = []
    handover = HandedOver(got)
    handover.opened(5)
    handover.from_link(6)
    handover.gone()
    assert got == []
    handover.let_time_pass()
    assert got == [6]
    assert not handover.reader.remote_publishers


@pytest.mark.parametrize("profile", [KEEP_ALL, QoSProfile(depth=5000)], ids=["keep_all", "deep"])
def test_a_reliable_subscription_holds_what_its_depth_allows_until_zenoh_has_caught_up(
    profile: QoSProfile,
) -> None:
    """In a large burst Zenoh is further behind than a few messages, and nothing may be lost."""
    got: list[int] = []
    handover = HandedOver(got, profile)
    handover.opened(500)
    for number in range(501, 3501):
        handover.from_link(number)
    assert got == []
    for number in range(1, 501):
        handover.from_zenoh(number)
    assert got == list(range(1, 3501))


# The stop of a lease, past the link


def linked(got: list[int]) -> HandedOver:
    """Return a subscription that takes a link."""
    handover = HandedOver(got)
    handover.opened(0)
    handover.from_link(1)
    assert handover.route is Route.LINK
    return handover


def test_a_stop_past_the_link_is_taken_at_once() -> None:
    """The link will not bring it before the publisher's loop goes on."""
    got: list[int] = []
    linked(got).from_other_loop(4)
    assert got == [1, 4]


def test_nothing_older_than_a_stop_is_taken_from_the_link() -> None:
    """Those commands were in the socket; the link brings the stop as well, and what follows."""
    got: list[int] = []
    handover = linked(got)
    handover.from_other_loop(4)
    for number in (2, 3, 4, 5):
        handover.from_link(number)
    assert got == [1, 4, 5]


def test_a_copy_of_a_stop_that_zenoh_has_brought_is_forgotten() -> None:
    """Zenoh carries it on the topic's key too, where others listen."""
    got: list[int] = []
    handover = linked(got)
    handover.from_zenoh(4)
    assert got == [1]
    handover.from_other_loop(4)
    handover.from_other_loop(4)
    handover.from_link(5)
    assert got == [1, 4, 5]


def test_a_stop_ends_a_hand_over() -> None:
    """Whatever Zenoh and the link have not brought by then is older."""
    got: list[int] = []
    handover = HandedOver(got)
    handover.from_zenoh(1)
    handover.opened(3)
    handover.from_link(4)
    handover.from_other_loop(5)
    handover.from_zenoh(2)
    handover.from_link(6)
    assert got == [1, 5, 6]
    assert handover.route is Route.LINK


def test_a_stop_that_comes_while_a_broken_link_is_made_good_is_taken() -> None:
    """What is sent again afterwards is older."""
    got: list[int] = []
    handover = linked(got)
    handover.broken()
    handover.from_zenoh(3)
    handover.from_other_loop(4)
    handover.from_retransmit(2)
    handover.retransmit_done()
    handover.from_zenoh(5)
    assert got == [1, 4, 5]
    assert handover.route is Route.ZENOH
