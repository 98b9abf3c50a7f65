"""A reader changes its way in the middle of a stream: each message once, in order, none lost."""

from __future__ import annotations

from collections import deque
from typing import TYPE_CHECKING

from hypothesis import given, settings
from hypothesis import strategies as st

from aionode.transport.base import Origin
from aionode.transport.link.handover import MAX_HELD, Handover, Way

if TYPE_CHECKING:
    from collections.abc import Callable

GID = bytes(16)


def origin(number: int) -> Origin:
    """Return the origin of a publisher's message."""
    return Origin(GID, number, 0, True)


class Stream:
    """A publisher, two ways that are each in order, and a reader at their end."""

    def __init__(self) -> None:
        self.published = 0
        self.got: list[int] = []
        self.handover = Handover(lambda msg, _: self.got.append(msg))
        self.zenoh: deque[int] = deque()
        self.link: deque[tuple[str, int]] = deque()
        self._linked = False
        self._needs_zenoh = True
        self._unconfirmed: list[int] = []

    def publish(self) -> None:
        """Send one message as the publisher of a link does."""
        self.published += 1
        if self._linked:
            self.link.append(("data", self.published))
            if not self._needs_zenoh:
                self._unconfirmed.append(self.published)
        if self._needs_zenoh:
            self.zenoh.append(self.published)

    def open(self) -> None:
        """Take the reader's wish."""
        if not self._linked and not self.link:  # it is asked for when the last one has ended
            self._linked = True
            self.link.append(("opened", self.published))

    def take_zenoh(self) -> None:
        """Hand over one message of Zenoh's."""
        if self.zenoh:
            number = self.zenoh.popleft()
            self._after(self.handover.from_zenoh(number, origin(number)))

    def take_link(self) -> None:
        """Hand over one frame of the link's."""
        if self.link:
            what, number = self.link.popleft()
            if what == "end":
                self.handover.broken()
            elif what == "opened":
                self._after(self.handover.opened(number))
            else:
                self._after(self.handover.from_link(number, origin(number)))

    def _after(self, switched: bool) -> None:
        if switched and self._linked and ("end", 0) not in self.link:
            self._needs_zenoh = False

    def end_link(self) -> None:
        """Break the link: the publisher notices now, the reader when it has read everything."""
        if self._linked:
            self._linked = False
            self._needs_zenoh = True
            self.link.append(("end", 0))
            self.zenoh.extend(self._unconfirmed)
            self._unconfirmed.clear()

    def finish(self) -> None:
        """Hand over everything, with one more message to end a hand-over."""
        self.publish()
        while self.zenoh:
            self.take_zenoh()
        while self.link:
            self.take_link()
        while self.zenoh:
            self.take_zenoh()


STEPS: list[Callable[[Stream], None]] = [
    Stream.publish,
    Stream.open,
    Stream.take_zenoh,
    Stream.take_link,
    Stream.end_link,
]


@given(st.lists(st.sampled_from(STEPS), max_size=60))
@settings(max_examples=400)
def test_each_message_comes_once_and_in_order_whatever_the_ways_do(
    steps: list[Callable[[Stream], None]],
) -> None:
    """Links come up and end at any moment of a stream, and either way may be the slower one."""
    stream = Stream()
    for step in steps:
        step(stream)
    stream.finish()
    assert stream.got == list(range(1, stream.published + 1))


def test_a_publisher_that_has_sent_nothing_is_taken_from_the_link_at_once() -> None:
    """Its first message has no reason to wait for Zenoh."""
    handover = Handover(lambda *_: None)
    assert handover.opened(0)
    assert handover.way is Way.LINK


def test_what_is_held_comes_out_when_zenoh_stays_silent() -> None:
    """Zenoh may have lost the message, or never have had it."""
    got: list[int] = []
    handover = Handover(lambda msg, _: got.append(msg))
    handover.opened(5)
    assert not handover.from_link(6, origin(6))
    assert handover.waits
    assert handover.switch()
    assert not handover.from_zenoh(6, origin(6))
    assert got == [6]


def test_no_more_than_so_many_are_held() -> None:
    """Memory has a bound, whatever Zenoh does."""
    got: list[int] = []
    handover = Handover(lambda msg, _: got.append(msg))
    handover.opened(1)
    switched = [handover.from_link(n, origin(n)) for n in range(2, MAX_HELD + 2)]
    assert switched == [False] * (MAX_HELD - 1) + [True]
    assert got == list(range(2, MAX_HELD + 2))


def test_after_a_link_has_ended_what_came_over_it_does_not_come_again() -> None:
    """Zenoh may still bring a copy from the time when both ways were used."""
    got: list[int] = []
    handover = Handover(lambda msg, _: got.append(msg))
    handover.opened(0)
    for number in (1, 2):
        handover.from_link(number, origin(number))
    handover.broken()
    for number in (2, 3):
        handover.from_zenoh(number, origin(number))
    assert got == [1, 2, 3]
