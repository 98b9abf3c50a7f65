"""The state machine of acknowledgements, tested without a network."""

from __future__ import annotations

import random
from typing import TYPE_CHECKING

import pytest
from hypothesis import given
from hypothesis import strategies as st

from aionode.engine.transport.reliability.limits import NEVER, QUIET_NS, WINDOW_BYTES
from aionode.engine.transport.reliability.stateful_reader import GONE_TICKS, StatefulReader
from aionode.engine.transport.reliability.stateful_writer import (
    FLAPPING_NS,
    HEARTBEAT_NS,
    KNOWN_NS,
    MAX_READERS,
    MUTE_TICKS,
    RETURN_NS,
    UNANSWERED_EACH_TICK,
    StatefulWriter,
)
from aionode.engine.transport.reliability.submessage import Submessage, SubmessageKind, pack, unpack

if TYPE_CHECKING:
    from aionode.engine.transport.reliability.reader_proxy import ReaderProxy
    from aionode.engine.transport.reliability.writer_proxy import WriterProxy

HEARTBEAT, ACKNACK, GAP, DATA = (
    SubmessageKind.HEARTBEAT,
    SubmessageKind.ACKNACK,
    SubmessageKind.GAP,
    SubmessageKind.DATA,
)

WRITER = b"w" * 16


class Clock:
    """A clock set by hand, in nanoseconds."""

    def __init__(self) -> None:
        self.ns = 1_000_000_000

    def __call__(self) -> int:
        """Return the time."""
        return self.ns


class Subscription:
    """A reader that records what it gets, and can be without room.

    Attributes:
        name: Its id.
        topic: Messages under way to it.
        heard: The numbers of the messages that it got.
        refusals: The ends of claims that it refused.
        beginnings: The numbers with which it started anew.
        answered_to: The contexts to which it sent its answers.
        announced: Whether its writer is announced.
    """

    def __init__(self, name: bytes, wire: Wire, *, has_history: bool = False) -> None:
        self.name = name
        self.topic: list[tuple[int, bytes]] = []
        self.heard: list[int] = []
        self.refusals: list[int] = []
        self.beginnings: list[int] = []
        self.answered_to: list[str] = []
        self.announced = True
        self.has_room = True
        self._waiting: list[tuple[int, WriterProxy]] = []
        self._wire = wire
        self.reader = StatefulReader(name, self, wire.clock, has_history=has_history)

    def receive(self, number: int, size: int) -> None:
        """Receive a message of the topic, as a transport does."""
        proxy = self.reader.proxies.get(WRITER)
        if proxy is None:
            if self.reader.receive_early(WRITER, number):
                self.heard.append(number)
        elif number == proxy.expected and self.has_room and not self._waiting:
            self.heard.append(number)
            proxy.receive_expected(size)
        else:
            proxy.receive(number, number, size)

    def make_room(self) -> None:
        """Use up the waiting messages."""
        self.has_room = True
        while self._waiting:
            number, proxy = self._waiting.pop(0)
            self.heard.append(number)
            proxy.used(10)

    # The output of the reader

    def accept(self, item: int, proxy: WriterProxy) -> bool:
        """Accept a message, or keep it waiting if there is no room."""
        if self._waiting or not self.has_room:
            self._waiting.append((item, proxy))
            return False
        self.heard.append(item)
        return True

    def item_of(self, submessage: Submessage) -> int:
        """Return the number of the message."""
        return submessage.first

    def send(self, participant: str, submessage: bytes) -> None:
        """Send a submessage to the writer."""
        self.answered_to.append(participant)
        self._wire.control.append(submessage)

    def participant_of(self, writer: bytes) -> str:
        """Return the context of the writer."""
        assert writer == WRITER
        return "writer" if self.announced else ""

    def has_arrivals(self) -> bool:
        """Return False: each message is received as it arrives."""
        return False

    def receive_arrivals(self) -> None:
        """Do nothing."""

    def malformed(self) -> None:
        """Fail: no submessage here is malformed."""
        raise AssertionError("no submessage here is malformed")

    def refused(self, last: int) -> None:
        """Record a refused claim."""
        self.refusals.append(last)

    def started_anew(self, first: int) -> None:
        """Record a new beginning."""
        self.beginnings.append(first)


class Wire:
    """A writer and its readers, with everything in transit in lists that a test empties.

    Attributes:
        control: The submessages under way.
        lost_count: How many messages the writer says were dropped.
        muted: The readers that the writer takes for mute.
        lost_contexts: The contexts to which the connection was lost.
    """

    def __init__(
        self, readers: int, *, keep_all: bool, depth: int, limit_bytes: int = 1 << 40
    ) -> None:
        self.clock = Clock()
        self.writer = StatefulWriter(
            *(WRITER, "writer", self, depth, limit_bytes),
            keep_all=keep_all,
            now_ns=self.clock,
            has_lost=lambda participant: participant in self.lost_contexts,
        )
        self.lost_contexts: set[str] = set()
        self.control: list[bytes] = []
        self.lost_count = 0
        self.muted: list[bytes] = []
        self.number = 0
        self.subscriptions = [Subscription(bytes([n]) * 16, self) for n in range(readers)]
        for each in self.subscriptions:
            self.writer.add(each.name, each.name.hex())

    def publish(self, size: int = 10) -> None:
        """Publish one message."""
        self.number += 1
        self.writer.write(self.number, self.number.to_bytes(size, "big"), b"")

    # The output of the writer

    def put(self, payload: bytes, extra: bytes) -> None:
        """Send to every reader."""
        assert extra == b""
        for each in self.subscriptions:
            reader = self.writer.readers.get(each.name)
            if reader is not None and not reader.away_until_ns:
                each.topic.append((int.from_bytes(payload, "big"), payload))

    def send(self, participant: str, submessage: bytes) -> None:
        """Send to one reader."""
        sent = unpack(submessage)
        assert sent is not None
        assert participant in (sent.reader.hex(), "liar")
        self.control.append(submessage)

    def source_ns(self, extra: bytes) -> int:
        """Return a time."""
        assert extra == b""
        return 7

    def mute(self, reader: ReaderProxy) -> None:
        """Record a mute reader."""
        self.muted.append(reader.gid)

    def lost(self, count: int) -> None:
        """Count lost messages."""
        self.lost_count += count

    # The way between

    def say(self, kind: SubmessageKind, name: bytes, first: int, last: int) -> None:
        """Send a submessage to a reader in the name of the writer."""
        rest = b"writer" if kind is HEARTBEAT else b""
        self.control.append(pack(kind, WRITER, name, first, last, rest))

    def under_way(self, kind: SubmessageKind) -> list[Submessage]:
        """Return the submessages of a kind that are in transit."""
        return [each for each in map(unpack, self.control) if each and each.kind is kind]

    def is_next(self, kind: SubmessageKind) -> bool:
        """Return whether the next submessage in transit is of a given kind."""
        submessage = unpack(self.control[0]) if self.control else None
        return submessage is not None and submessage.kind is kind

    def names_under_way(self) -> list[bytes]:
        """Return the reader of each submessage in transit."""
        return [each.reader for each in map(unpack, self.control) if each]

    def bring_topic(self, which: Subscription, *, lose: bool = False) -> None:
        """Deliver the next message, or lose it."""
        if which.topic:
            number, payload = which.topic.pop(0)
            if not lose and WRITER in which.reader.proxies:
                which.receive(number, len(payload))

    def bring_control(self, index: int = 0, *, lose: bool = False) -> None:
        """Deliver one of the submessages, or lose it."""
        if not self.control:
            return
        submessage = unpack(self.control.pop(index % len(self.control)))
        assert submessage is not None
        if lose:
            return
        if submessage.kind is ACKNACK:
            self.writer.acknack(submessage)
        for each in self.subscriptions:
            if each.name == submessage.reader and submessage.kind is not ACKNACK:
                each.reader.receive(submessage)

    def bring_all(self) -> None:
        """Deliver everything in transit."""
        while self.control or any(each.topic for each in self.subscriptions):
            for each in self.subscriptions:
                while each.topic:
                    self.bring_topic(each)
            while self.control:
                self.bring_control()

    def settle(self) -> None:
        """Deliver everything, and advance the time, until nothing happens any more."""
        for _ in range(10_000):
            self.bring_all()
            self.clock.ns += 60_000_000
            if not self.writer.tick() and not self.control:
                return
        raise AssertionError("it does not settle")


@given(
    keep_all=st.booleans(),
    readers=st.integers(1, 3),
    moves=st.lists(
        st.tuples(st.integers(0, 9), st.integers(0, 2), st.integers(0, 7)), max_size=200
    ),
)
def test_whatever_is_lost_on_the_way_each_reader_has_each_message_once_and_in_order(
    moves: list[tuple[int, int, int]], readers: int, *, keep_all: bool
) -> None:
    """This is the guarantee itself, whatever the order of events."""
    wire = Wire(readers, keep_all=keep_all, depth=100_000)
    for move, which, index in moves:
        reader = wire.subscriptions[which % readers]
        if move <= 2:
            for _ in range(index + 1):
                wire.publish()
        elif move <= 4:
            wire.bring_topic(reader, lose=move == 4)
        elif move <= 6:
            wire.bring_control(index, lose=move == 6)
        elif move == 7:
            reader.has_room = False
        elif move == 8:
            reader.make_room()
        else:
            wire.clock.ns += 30_000_000
            wire.writer.tick()
    for reader in wire.subscriptions:
        reader.make_room()
    wire.settle()
    everything = list(range(1, wire.number + 1))
    assert all(reader.heard == everything for reader in wire.subscriptions)
    assert wire.lost_count == 0
    assert wire.writer.done


@given(
    depth=st.integers(1, 5),
    moves=st.lists(st.tuples(st.integers(0, 6), st.integers(0, 7)), max_size=150),
)
def test_what_the_depth_drops_is_counted_and_the_rest_arrives_in_order(
    depth: int, moves: list[tuple[int, int]]
) -> None:
    """With one reader: missing messages were counted, and the last `depth` are there.

    One message more may be counted, if it is being retransmitted just as it is dropped.
    """
    wire = Wire(1, keep_all=False, depth=depth)
    (reader,) = wire.subscriptions
    for move, index in moves:
        if move <= 2:
            wire.publish(200_000 if index == 7 else 10)
        elif move <= 4:
            wire.bring_topic(reader, lose=move == 4)
        elif move == 5:
            if not reader.topic:  # # nothing overtakes messages in transit
                wire.bring_control(index)
        else:
            wire.clock.ns += 30_000_000
            wire.writer.tick()
    wire.settle()
    heard = reader.heard
    assert heard == sorted(set(heard))
    assert set(range(max(1, wire.number - depth + 1), wire.number + 1)) <= set(heard)
    assert wire.number - len(heard) <= wire.lost_count


def test_numbers_that_went_another_way_are_not_waited_for() -> None:
    """A publisher stops using Zenoh while links carry everything, and later uses it again."""
    wire = Wire(1, keep_all=True, depth=100)
    wire.publish()
    wire.number += 50
    wire.publish()
    wire.settle()
    assert wire.subscriptions[0].heard == [1, 52]
    assert wire.lost_count == 0


def test_a_gap_of_any_length_is_told_in_one_word() -> None:
    """A publisher that used a link for days returns to Zenoh."""
    wire = Wire(1, keep_all=True, depth=100)
    wire.settle()
    wire.publish()
    wire.number += 10**12
    wire.publish()
    wire.control.clear()  # # the GAP is lost, and requested again
    wire.settle()
    assert wire.subscriptions[0].heard == [1, 10**12 + 2]


def test_a_writer_sends_a_window_ahead_and_no_more() -> None:
    """Otherwise buffers on the way to a frozen reader would fill up."""
    wire = Wire(1, keep_all=True, depth=1000)
    for _ in range(900):
        wire.publish(10_000)
    assert 40 <= len(wire.subscriptions[0].topic) <= 60
    assert wire.writer.has_room()
    for _ in range(100):
        wire.publish(10_000)
    assert not wire.writer.has_room()
    wire.settle()
    assert wire.subscriptions[0].heard == list(range(1, 1001))


def test_what_was_dropped_before_it_was_sent_does_not_fill_the_window() -> None:
    """Otherwise a publisher of large messages would be stuck once its reader had lagged."""
    wire = Wire(1, keep_all=False, depth=1)
    for _ in range(20):
        wire.publish(200_000)
    wire.subscriptions[0].topic.clear()
    wire.settle()
    assert wire.subscriptions[0].heard == [20]
    assert wire.lost_count == 19


@pytest.mark.parametrize("acknowledges", [True, False])
def test_what_waits_for_a_frozen_reader_is_sent_to_a_new_one(*, acknowledges: bool) -> None:
    """No acknowledgement opens the window in that case."""
    wire = Wire(1, keep_all=False, depth=1000)
    topic = wire.subscriptions[0].topic
    for _ in range(100):
        wire.publish(10_000)
    waiting = len(topic)
    if acknowledges:
        wire.writer.add(b"n" * 16, (b"n" * 16).hex())
    else:
        wire.writer.has_other_readers = True
    wire.publish(10_000)
    assert len(topic) > waiting


def test_a_lagging_reader_holds_up_no_other_of_a_keep_last_writer() -> None:
    """One laptop that left the network must not silence the robot."""
    wire = Wire(2, keep_all=False, depth=10)
    slow, quick = wire.subscriptions
    for _ in range(500):
        wire.publish(10_000)
        while quick.topic:
            wire.bring_topic(quick)
        while quick.name in (names := wire.names_under_way()):
            wire.bring_control(names.index(quick.name))
    assert quick.heard == list(range(1, 501))
    slow.topic.clear()
    wire.settle()
    assert slow.heard == list(range(491, 501))
    assert wire.lost_count == 490


def vanish_frozen(wire: Wire, reader: Subscription) -> None:
    """Let a reader be silent until its lease expires; everything in transit to it is lost."""
    wire.clock.ns += 10_000_000_000
    wire.writer.remove(reader.name)
    reader.topic.clear()


@pytest.mark.parametrize("back", [True, False])
def test_the_place_of_a_reader_that_vanished_silently_is_kept_for_a_while(*, back: bool) -> None:
    """It was frozen for longer than its lease; KEEP_ALL loses nothing when it returns."""
    wire = Wire(1, keep_all=True, depth=1000)
    (reader,) = wire.subscriptions
    wire.bring_control()
    wire.bring_control()  # its answer
    wire.publish()
    vanish_frozen(wire, reader)
    for _ in range(50):
        wire.publish()
    assert not wire.writer.done
    if back:
        wire.writer.add(reader.name, reader.name.hex())
        wire.settle()
        assert reader.heard == list(range(1, 52))
        assert wire.lost_count == 0
    else:
        wire.clock.ns += RETURN_NS
        wire.writer.tick()
        assert wire.writer.done
        assert wire.lost_count == 51  # type: ignore[unreachable]


def test_nothing_is_kept_for_a_reader_that_vanished_without_any_answer() -> None:
    """Any program may announce a subscription; aionode's readers answer at once."""
    wire = Wire(1, keep_all=True, depth=1000)
    for _ in range(50):
        wire.publish()
    wire.clock.ns += 10_000_000_000

    wire.writer.remove(wire.subscriptions[0].name)

    assert wire.writer.done


def test_a_keep_all_writer_has_no_room_beyond_its_bytes() -> None:
    """Ten thousand large messages for a reader that never answers would take gigabytes."""
    wire = Wire(1, keep_all=True, depth=10_000, limit_bytes=100_000)
    count = 0
    while wire.writer.has_room():
        wire.publish(10_000)
        count += 1

    assert 10 <= count <= 12
    wire.settle()
    assert wire.writer.has_room()


def test_a_keep_last_writer_drops_its_oldest_beyond_its_bytes() -> None:
    """They are counted, like messages beyond its depth."""
    wire = Wire(1, keep_all=False, depth=10_000, limit_bytes=1_000_000)
    (reader,) = wire.subscriptions
    for _ in range(1_000):
        wire.publish(10_000)

    size_bytes = sum(len(entry[1]) for entry in wire.writer.entries)
    assert 900_000 < size_bytes <= 1_000_000
    wire.settle()
    assert wire.writer.done
    assert len(reader.heard) + wire.lost_count == 1_000


def test_one_message_is_kept_whatever_its_size() -> None:
    """The limit does not restrict the size of a single message."""
    wire = Wire(1, keep_all=False, depth=10, limit_bytes=100)
    wire.publish(10_000)
    wire.settle()

    assert wire.subscriptions[0].heard == [1]


def test_a_reader_holds_few_bytes_while_a_message_is_missing() -> None:
    """A writer that skips one number and continues must not fill its readers' memory."""
    wire = Wire(1, keep_all=True, depth=10_000)
    (reader,) = wire.subscriptions
    wire.bring_control()
    proxy = reader.reader.proxies[WRITER]

    for number in range(2, 1_000):
        proxy.receive(number, number, 100_000)

    assert reader.heard == []
    proxy.receive(1, 1, 100_000)
    assert reader.heard == list(range(1, 12))  # # a megabyte was held; the rest is sent again


def test_a_reader_that_answered_just_now_has_ended_when_it_vanishes() -> None:
    """A killed process must not block a KEEP_ALL publisher."""
    wire = Wire(1, keep_all=True, depth=1000)
    for _ in range(10):
        wire.publish()
    wire.clock.ns += 1_000_000_000
    wire.writer.remove(wire.subscriptions[0].name)
    assert wire.writer.done
    assert wire.lost_count == 0


@pytest.mark.parametrize("answers", [True, False])
def test_an_idle_keep_all_writer_knows_whether_a_vanished_reader_was_frozen(
    *, answers: bool
) -> None:
    """All is acknowledged, so only a probe distinguishes a frozen reader from a killed one."""
    wire = Wire(1, keep_all=True, depth=1000)
    (reader,) = wire.subscriptions
    wire.publish()
    wire.settle()
    for _ in range(10):
        wire.clock.ns += 1_000_000_000
        assert wire.writer.probe()
        if answers:
            wire.settle()
        wire.control.clear()
    wire.writer.remove(reader.name)
    wire.clock.ns += KNOWN_NS
    wire.writer.tick()
    assert (reader.name in wire.writer.readers) is not answers
    wire.publish()
    reader.topic.clear()
    if not answers:
        wire.writer.add(reader.name, reader.name.hex())
        wire.settle()
        assert reader.heard == [1, 2]
    assert wire.writer.done
    assert wire.lost_count == 0


def test_a_reader_that_answers_anyway_is_not_probed() -> None:
    """Probes are for silent readers: a busy publisher sends none."""
    wire = Wire(1, keep_all=True, depth=1000)
    wire.publish()
    wire.settle()
    assert wire.writer.probe()
    assert not wire.control
    wire.writer.remove(wire.subscriptions[0].name)
    wire.clock.ns += KNOWN_NS
    wire.writer.tick()
    assert not wire.writer.probe()


def is_data(submessage: bytes) -> bool:
    """Return whether it is a retransmitted message."""
    data = unpack(submessage)
    return data is not None and data.kind is DATA


def test_a_heavy_loss_is_made_good_without_sending_much_twice() -> None:
    """A storm of retransmissions would make congestion worse."""
    wire = Wire(1, keep_all=False, depth=20_000)
    (reader,) = wire.subscriptions
    dice = random.Random(1)  # noqa: S311  # the same each time
    resent = 0
    for _ in range(5_000):
        wire.publish(100)
    for _ in range(5_000):
        wire.bring_topic(reader, lose=dice.random() < 0.3)
        wire.clock.ns += 50_000
        while wire.control:
            resent += is_data(wire.control[0])
            wire.bring_control()
    wire.settle()
    assert reader.heard == list(range(1, 5_001))
    assert resent < 3_000


def test_a_reader_that_vanishes_again_soon_after_its_return_misses_nothing() -> None:
    """For a while after a process was frozen, connections break and are made again."""
    wire = Wire(1, keep_all=True, depth=1000)
    (reader,) = wire.subscriptions
    wire.settle()
    wire.publish()
    vanish_frozen(wire, reader)
    wire.publish()
    for is_heard in (False, True):
        wire.writer.add(reader.name, reader.name.hex())
        if is_heard:
            wire.settle()
        wire.clock.ns += 1_000_000_000
        wire.writer.remove(reader.name)
        reader.topic.clear()
        wire.publish()
    wire.writer.add(reader.name, reader.name.hex())
    wire.settle()
    assert reader.heard == [1, 2, 3, 4]
    assert wire.lost_count == 0


def test_a_reader_that_ends_soon_after_its_return_holds_nothing_up_for_long() -> None:
    """It is not waited for as long as a reader that was silent before it vanished."""
    wire = Wire(1, keep_all=True, depth=1000)
    (reader,) = wire.subscriptions
    wire.settle()
    wire.publish()
    vanish_frozen(wire, reader)
    wire.writer.add(reader.name, reader.name.hex())
    wire.settle()
    wire.writer.remove(reader.name)
    wire.publish()
    assert not wire.writer.done
    wire.clock.ns += FLAPPING_NS
    wire.writer.tick()
    assert wire.writer.done


def cut_off(wire: Wire, reader: Subscription) -> None:
    """Break the connection to a reader that answers."""
    wire.settle()
    wire.writer.remove(reader.name)
    wire.lost_contexts.add(reader.name.hex())


@pytest.mark.parametrize("keep_all", [True, False])
def test_a_reader_whose_connection_breaks_for_a_moment_misses_nothing(*, keep_all: bool) -> None:
    """It answers, so it is not frozen; messages are kept for it as well."""
    wire = Wire(1, keep_all=keep_all, depth=10)
    (reader,) = wire.subscriptions
    cut_off(wire, reader)
    for _ in range(10):
        wire.publish()

    wire.writer.add(reader.name, reader.name.hex())

    wire.settle()
    assert reader.heard == list(range(1, 11))
    assert wire.lost_count == 0


@pytest.mark.parametrize("limit_bytes", [1 << 40, 1000], ids=["messages", "bytes"])
def test_a_reader_that_is_cut_off_leaves_a_keep_all_writer_room(limit_bytes: int) -> None:
    """Its process may have exited. If it returns, it gets everything published from then on."""
    wire = Wire(2, keep_all=True, depth=10, limit_bytes=limit_bytes)
    reader, other = wire.subscriptions
    cut_off(wire, reader)
    for _ in range(100):
        assert wire.writer.has_room()
        wire.publish()
        wire.bring_all()
        wire.clock.ns += QUIET_NS
        wire.writer.tick()
        wire.bring_all()
    assert other.heard == list(range(1, 101))
    assert wire.writer.done

    wire.writer.add(reader.name, reader.name.hex())
    wire.settle()
    wire.publish()
    wire.settle()
    assert reader.heard[-1] == 101
    assert wire.writer.done


def test_a_reader_that_ends_beside_a_living_connection_is_forgotten_soon() -> None:
    """Its writer keeps messages only until it would have noticed a lost connection."""
    wire = Wire(1, keep_all=True, depth=10)
    (reader,) = wire.subscriptions
    wire.settle()
    wire.writer.remove(reader.name)
    wire.publish()
    assert wire.writer.done
    assert wire.writer.entries

    wire.clock.ns += KNOWN_NS

    assert not wire.writer.tick()
    assert not wire.writer.readers
    assert not wire.writer.entries
    assert wire.lost_count == 0


def test_nobody_makes_a_writer_wait_for_thousands_of_readers() -> None:
    """A process can announce them, answer for each, and break its connection repeatedly."""
    wire = Wire(0, keep_all=True, depth=10)
    for number in range(5 * MAX_READERS):
        gid = number.to_bytes(16, "big")
        wire.writer.add(gid, gid.hex())
        wire.writer.acknack(Submessage(ACKNACK, WRITER, gid, 1, 0, b""))
        wire.lost_contexts.add(gid.hex())
        wire.writer.remove(gid)
    wire.control.clear()

    assert len(wire.writer.readers) == MAX_READERS


@pytest.mark.parametrize("keep_all", [True, False])
def test_a_reader_that_ends_with_its_process_holds_up_no_end_and_has_lost_nothing(
    *, keep_all: bool
) -> None:
    """Its connection breaks as well, and the order of the two events cannot be known."""
    wire = Wire(1, keep_all=keep_all, depth=10)
    (reader,) = wire.subscriptions
    cut_off(wire, reader)
    wire.publish()

    assert wire.writer.done
    wire.clock.ns += FLAPPING_NS
    assert not wire.writer.tick()
    assert not wire.writer.entries
    assert wire.lost_count == 0
    assert wire.writer.give_up() == 0


def test_the_stop_of_a_lease_waits_for_no_window() -> None:
    """Messages waiting before it are dropped and counted; the stop comes last."""
    wire = Wire(1, keep_all=False, depth=1000)
    (reader,) = wire.subscriptions
    for _ in range(20):
        wire.publish(WINDOW_BYTES // 4)
    assert wire.writer.unsent
    sent = len(reader.topic)
    wire.number += 1

    wire.writer.write_stop(wire.number, wire.number.to_bytes(10, "big"), b"", wire.put)

    assert [number for number, _ in reader.topic] == [*range(1, sent + 1), wire.number]
    assert wire.lost_count == 20 - sent
    wire.settle()
    assert reader.heard == [*range(1, sent + 1), wire.number]


def test_a_stop_that_was_sent_already_is_sent_again_only_to_those_who_lack_it() -> None:
    """Another thread has sent it; here it is added to the history."""
    wire = Wire(1, keep_all=False, depth=10)
    (reader,) = wire.subscriptions
    wire.publish()

    wire.writer.write_stop(2, (2).to_bytes(10, "big"), b"", lambda _payload, _extra: None)

    assert [number for number, _ in reader.topic] == [1]
    wire.settle()
    assert reader.heard == [1, 2]
    wire.number = 2
    wire.publish()
    wire.settle()
    assert reader.heard == [1, 2, 3]


# HEARTBEAT and GAP in the writer's name

FAR = 2**62


def hear(wire: Wire, count: int) -> None:
    """Publish some messages, which arrive at the only reader."""
    for _ in range(count):
        wire.publish()
        wire.bring_topic(wire.subscriptions[0])


@pytest.mark.parametrize("ahead", [1, 50, 4_000, 5_000, FAR])
@pytest.mark.parametrize("kind", [HEARTBEAT, GAP])
def test_what_is_said_in_a_writers_name_makes_its_reader_miss_nothing(
    kind: SubmessageKind, ahead: int
) -> None:
    """Neither slightly ahead of what has arrived, nor so far that the topic would fall silent."""
    wire = Wire(1, keep_all=False, depth=10)
    (reader,) = wire.subscriptions
    wire.bring_control()
    hear(wire, 10)
    for _ in range(3):
        lie = {HEARTBEAT: (10 + ahead, FAR), GAP: (1, 10 + ahead)}[kind]
        wire.say(kind, reader.name, *lie)
        wire.bring_control(-1)
        hear(wire, 10)
    wire.settle()

    assert reader.heard == list(range(1, 41))
    assert wire.writer.done
    assert reader.reader.proxies[WRITER].expected == 41


@given(
    moves=st.lists(
        st.tuples(st.integers(0, 5), st.integers(-3, 8), st.sampled_from([0, 5, 4_000, 5_000])),
        max_size=60,
    )
)
def test_whatever_is_said_in_a_writers_name_each_message_that_comes_is_taken_in_order(
    moves: list[tuple[int, int, int]],
) -> None:
    """False claims beside a stream that loses nothing in transit and is never reordered.

    A false claim may make the writer retransmit a message. If that overtakes an earlier message,
    the earlier one is lost, because messages are delivered in order.
    """
    wire = Wire(1, keep_all=True, depth=100_000)
    (reader,) = wire.subscriptions
    wire.bring_control()
    for move, near, far in moves:
        number = wire.number + near + far
        if move <= 1:
            wire.publish()
        elif move == 2:
            wire.bring_topic(reader)
        elif move == 3:
            wire.say(HEARTBEAT, reader.name, number, number + near)
        elif move == 4:
            wire.say(GAP, reader.name, number - 10, number)
        else:
            while reader.topic and wire.is_next(DATA):
                wire.bring_topic(reader)
            wire.bring_control()
    wire.settle()

    assert reader.heard == list(range(1, wire.number + 1))
    assert wire.lost_count == 0


def test_a_claim_beyond_what_was_sent_is_refused_and_told() -> None:
    """The next true HEARTBEAT contradicts it."""
    wire = Wire(1, keep_all=False, depth=10)
    (reader,) = wire.subscriptions
    wire.bring_control()
    hear(wire, 3)
    wire.say(HEARTBEAT, reader.name, FAR, FAR)
    wire.bring_control(-1)
    wire.control.clear()
    wire.publish()
    wire.settle()

    assert reader.refusals == [FAR]
    assert reader.heard == [1, 2, 3, 4]


def test_a_reader_believes_how_far_its_writer_came_while_it_was_stopped() -> None:
    """The claim is true: the reader asks for the message at its end, and gets it."""
    wire = Wire(2, keep_all=False, depth=10)
    slow, quick = wire.subscriptions
    for _ in range(20_000):
        wire.publish()
        wire.bring_topic(quick)
        while quick.name in (names := wire.names_under_way()):
            wire.bring_control(names.index(quick.name))
    slow.topic.clear()
    wire.settle()

    assert slow.heard == list(range(19_991, 20_001))
    assert wire.lost_count == 19_990
    assert slow.refusals == []
    assert slow.beginnings == []


@pytest.mark.parametrize("far", [1, 5_000])
def test_a_gap_of_numbers_that_went_another_way_needs_no_answer(far: int) -> None:
    """The message after it proves the claim; a filter may hold back very many messages."""
    wire = Wire(1, keep_all=True, depth=100)
    (reader,) = wire.subscriptions
    wire.bring_control()
    hear(wire, 1)
    wire.control.clear()
    wire.number += far
    wire.publish()
    wire.bring_control()
    wire.bring_topic(reader)

    assert reader.heard == [1, far + 2]


def test_a_lie_does_not_keep_a_writer_from_learning_that_everything_arrived() -> None:
    """Otherwise it would wait, at its end, for an acknowledgement beyond what it has sent."""
    wire = Wire(1, keep_all=True, depth=10)
    (reader,) = wire.subscriptions
    wire.bring_control()
    hear(wire, 1)
    wire.say(HEARTBEAT, reader.name, 10, 14)
    wire.settle()

    assert wire.writer.done


def test_a_first_heartbeat_that_lies_costs_no_message() -> None:
    """A reader has no other source for the start of a stream, and believes it until data comes."""
    wire = Wire(1, keep_all=False, depth=10)
    (reader,) = wire.subscriptions
    wire.say(HEARTBEAT, reader.name, FAR, FAR)
    wire.bring_control(-1)
    hear(wire, 5)
    wire.settle()

    assert reader.heard == [1, 2, 3, 4, 5]
    assert reader.beginnings == [1]


def test_a_reader_that_gets_only_messages_far_below_what_it_expects_starts_anew() -> None:
    """Anyone allowed to publish the topic can send a wrong number; the reader recovers."""
    wire = Wire(1, keep_all=False, depth=10)
    (reader,) = wire.subscriptions
    wire.bring_control()
    hear(wire, 5)
    proxy = reader.reader.proxies[WRITER]
    for number in range(1_000_000, 1_000_002):
        proxy.heartbeat(number, number)
        proxy.receive(number, number, 10)
    for _ in range(30):
        hear(wire, 1)
        wire.clock.ns += 100_000_000

    assert reader.heard == [1, 2, 3, 4, 5, 1_000_000, 1_000_001, *range(21, 36)]
    assert reader.beginnings == [21]


def test_messages_that_were_only_overtaken_do_not_begin_a_stream_anew() -> None:
    """A burst of old or retransmitted messages would otherwise be delivered out of order."""
    wire = Wire(1, keep_all=False, depth=10)
    (reader,) = wire.subscriptions
    wire.bring_control()
    hear(wire, 5)
    proxy = reader.reader.proxies[WRITER]
    proxy.receive(1_000_000, 1_000_000, 10)
    proxy.heartbeat(1_000_000, 1_000_000)
    proxy.receive(1_000_001, 1_000_001, 10)
    heard = list(reader.heard)
    for number in range(6, 100):
        proxy.receive(number, number, 10)
    for number in range(100, 200):
        wire.clock.ns += 100_000_000
        proxy.receive(number, number, 10, is_resent=True)

    assert reader.heard == heard


def test_readers_that_never_answer_are_asked_a_few_at_a_time() -> None:
    """Anyone can announce thousands of readers; asking all at once would block the event loop."""
    wire = Wire(1, keep_all=False, depth=10)
    hear(wire, 1)
    wire.settle()
    for number in range(1, 51):
        wire.writer.add(number.to_bytes(16, "big"), "liar")
    (reader,) = wire.subscriptions
    wire.publish()
    asked = []
    for _ in range(10):
        wire.control.clear()
        wire.clock.ns += HEARTBEAT_NS // 10
        wire.writer.tick()
        asked.append([each.reader for each in wire.under_way(HEARTBEAT)])

    assert max(map(len, asked)) <= UNANSWERED_EACH_TICK + 1
    assert reader.name in {each for some in asked for each in some}
    assert len({each for some in asked for each in some}) == 51


def forget(wire: Wire, name: bytes) -> None:
    """Lose the submessages to and from a reader."""
    names = wire.names_under_way()
    wire.control = [each for each, to in zip(wire.control, names, strict=True) if to != name]


@pytest.mark.parametrize("keep_all", [True, False])
def test_a_reader_that_never_answers_is_waited_for_some_seconds_only(*, keep_all: bool) -> None:
    """Any program may announce one and claim to acknowledge; other readers still get everything."""
    wire = Wire(2, keep_all=keep_all, depth=10_000)
    liar, reader = wire.subscriptions
    forget(wire, liar.name)
    count = 2 * WINDOW_BYTES // 1000
    for _ in range(count):
        wire.publish(1000)
    held_at = []
    for _ in range(MUTE_TICKS + 1):
        while reader.topic:
            wire.bring_topic(reader)
        forget(wire, liar.name)
        while wire.control:
            wire.bring_control()
        held_at.append(len(reader.heard))
        wire.clock.ns += 60_000_000
        wire.writer.tick()
    wire.settle()

    assert (held_at[-2] < count) is keep_all
    assert wire.muted == [liar.name]
    assert reader.heard == list(range(1, count + 1))
    assert wire.lost_count >= 512 * 1024 // 1200
    assert liar.name not in wire.writer.readers
    assert wire.writer.done


def test_a_reader_that_has_answered_once_is_not_taken_for_mute() -> None:
    """It is slow, or was frozen: KEEP_ALL waits for it."""
    wire = Wire(1, keep_all=True, depth=100)
    wire.settle()
    wire.bring_control()
    wire.bring_control()
    wire.publish()
    for _ in range(2 * MUTE_TICKS):
        wire.control.clear()
        wire.clock.ns += 60_000_000
        wire.writer.tick()

    assert wire.muted == []
    assert not wire.writer.done


# # The reader's side only


def test_a_reader_without_room_is_sent_no_more_than_a_window() -> None:
    """Nothing in transit has to wait for it, and it keeps reporting that it has used nothing."""
    wire = Wire(1, keep_all=True, depth=10_000)
    (reader,) = wire.subscriptions
    wire.bring_control()
    reader.has_room = False
    for _ in range(1_000):
        wire.publish(1_000)
    for _ in range(50):
        while reader.topic:
            wire.bring_topic(reader)
        while wire.control:
            wire.bring_control()
        wire.clock.ns += 60_000_000
        wire.writer.tick()

    assert wire.writer.unsent
    assert wire.writer.sent <= WINDOW_BYTES // 1_000
    assert reader.heard == []
    reader.make_room()
    wire.settle()
    assert reader.heard == list(range(1, 1_001))


@pytest.mark.parametrize("announced", [True, False])
def test_a_heartbeat_in_a_writers_name_leads_no_answer_astray(*, announced: bool) -> None:
    """A KEEP_ALL writer would wait for it for good; once announced, the announcement counts."""
    wire = Wire(1, keep_all=True, depth=10)
    (reader,) = wire.subscriptions
    reader.announced = announced
    for _ in range(2):
        wire.control.append(pack(HEARTBEAT, WRITER, reader.name, 1, 0, b"abc"))
        wire.bring_control(-1)
    assert reader.answered_to == (["writer", "writer"] if announced else ["abc", "abc"])

    reader.announced = True
    wire.publish()
    wire.settle()
    assert reader.answered_to[-1] == "writer"
    assert wire.writer.done


def test_a_heartbeat_that_names_no_context_is_malformed() -> None:
    """The answer would go to a key chosen by the sender."""
    wire = Wire(1, keep_all=True, depth=10)
    (reader,) = wire.subscriptions
    reader.announced = False
    wire.control = [pack(HEARTBEAT, WRITER, reader.name, 1, 0, b"a/**")]
    with pytest.raises(AssertionError, match="malformed"):
        wire.bring_control()
    assert not reader.reader.proxies


def test_a_reader_that_was_frozen_does_not_give_its_writer_up() -> None:
    """When it resumes, its clock has jumped, and the writer is not announced yet."""
    wire = Wire(1, keep_all=True, depth=10)
    (reader,) = wire.subscriptions
    wire.bring_control()
    wire.publish()
    reader.topic.clear()
    wire.publish()
    wire.bring_topic(reader)
    reader.announced = False
    wire.clock.ns += NEVER

    assert all(reader.reader.tick() for _ in range(GONE_TICKS - 1))
    assert reader.heard == []
    assert not reader.reader.tick()
    assert reader.heard == [2]


@pytest.mark.parametrize("is_forgotten", [True, False], ids=["forgotten", "waited for"])
def test_a_reader_with_a_history_that_returns_gets_each_message_once(*, is_forgotten: bool) -> None:
    """They come from the history if its writer thought it had ended, and otherwise from both."""
    wire = Wire(0, keep_all=True, depth=100)
    reader = Subscription(b"r" * 16, wire, has_history=True)
    wire.subscriptions.append(reader)
    wire.publish()
    wire.writer.add(reader.name, reader.name.hex())
    wire.bring_control()
    assert not reader.reader.proxies  # the history is still to come
    reader.receive(1, 10)
    wire.settle()
    wire.publish()
    wire.clock.ns += 60_000_000
    wire.writer.tick()
    wire.settle()
    assert reader.heard == [1, 2]

    wire.clock.ns += 100 if is_forgotten else 10_000_000_000
    if not is_forgotten:
        wire.publish()  # # the reader waits for it, as it lacks this one
        reader.topic.clear()
    wire.writer.remove(reader.name)
    if is_forgotten:
        wire.clock.ns += KNOWN_NS
        wire.writer.tick()
        assert not wire.writer.readers
    for _ in range(50):
        wire.publish()
    reader.topic.clear()
    wire.writer.add(reader.name, reader.name.hex())
    wire.bring_control()
    for number in range(1, wire.number + 1):
        reader.receive(number, 10)
    wire.settle()
    wire.publish()
    wire.settle()

    assert reader.heard == list(range(1, wire.number + 1))
    assert reader.beginnings == []  # # there was no false claim
    assert wire.lost_count == 0
