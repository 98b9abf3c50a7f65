"""A reader changes its way in the middle of a stream: each message once, in order, none lost."""

from __future__ import annotations

from collections import deque
from typing import TYPE_CHECKING

from hypothesis import given, settings
from hypothesis import strategies as st

from aionode.transport.base import SampleInfo
from aionode.transport.ipc._protocol import MAX_HELD, Handover, Route

if TYPE_CHECKING:
    from collections.abc import Callable

GID = bytes(16)


def sample_info(number: int) -> SampleInfo:
    """Return the origin of a publisher's message."""
    return SampleInfo(GID, number, 0, True)


class Stream:
    """A publisher, three ways that are each in order, and a reader at their end."""

    def __init__(self) -> None:
        self.published = 0
        self.got: list[int] = []
        self.handover = Handover(lambda msg, *_: self.got.append(msg))
        self.zenoh: deque[int] = deque()
        self.retransmit: deque[tuple[str, int]] = deque()
        self.link: deque[tuple[str, int]] = deque()
        self._linked = False
        self._needs_zenoh = True
        self._unconfirmed: list[int] = []

    def publish(self) -> None:
        """Send one message as the publisher of a link does."""
        self.published += 1
        if self._linked:
            self.link.append(("data", self.published))
            self._unconfirmed.append(self.published)
        if self._needs_zenoh:
            self.zenoh.append(self.published)

    def open(self) -> None:
        """Take the reader's wish, a while after the last link has ended: its post has come."""
        if not self._linked and not self.link and not self.retransmit:
            self._linked = True
            self.link.append(("opened", self.published))

    def meet_stranger(self) -> None:
        """Publish both ways from now on, for somebody else."""
        self._needs_zenoh = True

    def lose_stranger(self) -> None:
        """Publish over the link alone, if the reader has taken it."""
        self._needs_zenoh = not (self._linked and self.handover.route is Route.IPC)

    def confirm(self) -> None:
        """Say what has been delivered."""
        if self._linked and self.handover.route is Route.IPC:
            self._unconfirmed = [n for n in self._unconfirmed if n > self.handover.last]

    def take_zenoh(self) -> None:
        """Hand over one message of Zenoh's."""
        if self.zenoh:
            number = self.zenoh.popleft()
            self.handover.from_zenoh(number, sample_info(number))
            self.lose_stranger()

    def take_post(self) -> None:
        """Hand over one message of the post, which is behind all of the link and its end."""
        while self.link and self.retransmit:
            self.take_link()
        if self.retransmit:
            what, number = self.retransmit.popleft()
            if what == "caught up":
                self.handover.retransmit_done()
            else:
                self.handover.from_retransmit(number, sample_info(number))

    def take_link(self) -> None:
        """Hand over one frame of the link's."""
        if self.link:
            what, number = self.link.popleft()
            if what == "end":
                self.handover.broken()
            elif what == "opened":
                self.handover.opened(number)
            else:
                self.handover.from_link(number, sample_info(number))
            self.lose_stranger()

    def end_link(self) -> None:
        """Break the link: what is in it may be lost, and is posted by the publisher."""
        if self._linked:
            self._linked = False
            self._needs_zenoh = True
            self.link.append(("end", 0))
            self.retransmit.extend(("data", number) for number in self._unconfirmed)
            self.retransmit.append(("caught up", 0))
            self._unconfirmed.clear()

    def lose_what_is_under_way(self) -> None:
        """Break the link, with all that is in it."""
        if self._linked:
            self.link.clear()
            self.end_link()

    def finish(self) -> None:
        """Hand over everything, with one more message to end a hand-over."""
        self.publish()
        for take, route in (
            (self.take_zenoh, self.zenoh),
            (self.take_link, self.link),
            (self.take_zenoh, self.zenoh),
            (self.take_post, self.retransmit),
        ):
            while route:
                take()


STEPS: list[Callable[[Stream], None]] = [
    Stream.publish,
    Stream.publish,
    Stream.open,
    Stream.confirm,
    Stream.meet_stranger,
    Stream.lose_stranger,
    Stream.take_zenoh,
    Stream.take_post,
    Stream.take_link,
    Stream.end_link,
    Stream.lose_what_is_under_way,
]


@given(st.lists(st.sampled_from(STEPS), max_size=80))
@settings(max_examples=600)
def test_each_message_comes_once_and_in_order_whatever_the_ways_do(
    steps: list[Callable[[Stream], None]],
) -> None:
    """Links come up and end at any moment of a stream, and any way may be the slower one."""
    stream = Stream()
    for step in steps:
        step(stream)
    stream.finish()
    assert stream.got == list(range(1, stream.published + 1))


def test_a_publisher_that_has_sent_nothing_is_taken_from_the_link_at_once() -> None:
    """Its first message has no reason to wait for Zenoh."""
    handover = Handover(lambda *_: None)
    handover.opened(0)
    assert handover.route is Route.IPC


def test_the_last_message_before_the_link_shows_that_nothing_is_under_way() -> None:
    """Then nothing has to wait for the next one."""
    got: list[int] = []
    handover = Handover(lambda msg, *_: got.append(msg))
    handover.opened(5)
    handover.from_zenoh(5, sample_info(5))
    assert handover.route is Route.IPC
    handover.from_link(6, sample_info(6))
    assert got == [5, 6]


def test_what_is_held_comes_out_when_zenoh_stays_silent() -> None:
    """Zenoh may have lost the message, or never have had it."""
    got: list[int] = []
    handover = Handover(lambda msg, *_: got.append(msg))
    handover.opened(5)
    handover.from_link(6, sample_info(6))
    assert handover.waits
    handover.switch()
    assert handover.route is Route.IPC
    handover.from_zenoh(6, sample_info(6))
    assert got == [6]


def test_no_more_than_so_many_are_held() -> None:
    """Memory has a bound, whatever Zenoh does."""
    got: list[int] = []
    handover = Handover(lambda msg, *_: got.append(msg))
    handover.opened(1)
    for number in range(2, MAX_HELD + 1):
        handover.from_link(number, sample_info(number))
    assert got == []
    handover.from_link(MAX_HELD + 1, sample_info(MAX_HELD + 1))
    assert handover.route is Route.IPC
    assert got == list(range(2, MAX_HELD + 2))


def test_copies_that_zenoh_brings_ahead_of_the_link_are_bounded() -> None:
    """They all come over the link as well, or by post when that ends."""
    got: list[int] = []
    handover = Handover(lambda msg, *_: got.append(msg))
    handover.opened(0)
    for number in range(1, MAX_HELD + 100):
        handover.from_zenoh(number, sample_info(number))
    handover.broken()
    for number in range(1, 100):
        handover.from_retransmit(number, sample_info(number))
    assert got == list(range(1, MAX_HELD + 100))


def test_after_a_link_has_ended_what_came_over_it_does_not_come_again() -> None:
    """Zenoh may still bring a copy from the time when both ways were used."""
    got: list[int] = []
    handover = Handover(lambda msg, *_: got.append(msg))
    handover.opened(0)
    for number in (1, 2):
        handover.from_link(number, sample_info(number))
    handover.broken()
    for number in (2, 3):
        handover.from_zenoh(number, sample_info(number))
    assert got == [1, 2, 3]


def test_what_was_lost_for_good_is_waited_for_only_until_it_is_given_up() -> None:
    """The publisher may have been killed before it could post anything."""
    got: list[int] = []
    handover = Handover(lambda msg, *_: got.append(msg))
    handover.opened(0)
    handover.from_link(1, sample_info(1))
    handover.broken()
    handover.from_zenoh(3, sample_info(3))
    assert handover.waits
    assert got == [1]
    handover.finish()
    assert handover.route is Route.ZENOH
    assert got == [1, 3]


def test_what_comes_over_a_link_for_another_reader_is_left_to_zenoh() -> None:
    """Before it is opened, older messages may still be on their way over Zenoh."""
    got: list[int] = []
    handover = Handover(lambda msg, *_: got.append(msg))
    handover.from_link(7, sample_info(7))
    handover.from_zenoh(6, sample_info(6))
    assert got == [6]
