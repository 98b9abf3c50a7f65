"""The state machine of acknowledgements, without a network."""

from __future__ import annotations

import random
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from aionode.transport.zenoh._reliability import (
    FLAPPING_NS,
    HEARTBEAT_NS,
    MUTE_TICKS,
    RETURN_NS,
    UNANSWERED_EACH_TICK,
    WINDOW_BYTES,
    ReaderProxy,
    WriterHistory,
)
from aionode.transport.zenoh._writer_proxy import WriterProxy

WRITER = b"w" * 16


class Clock:
    """Time by hand, in nanoseconds."""

    def __init__(self) -> None:
        self.ns = 1_000_000_000

    def __call__(self) -> int:
        """Return the time."""
        return self.ns


class Wire:
    """A writer and its readers, with everything on its way in lists that a test empties.

    Attributes:
        topic: Messages under way to each reader.
        control: The rest under way, as calls.
        heard: What each reader was given.
        lost: How many the writer says were dropped.
        refusals: The ends of claims that were refused.
        beginnings: With which numbers readers started anew.
    """

    def __init__(
        self, readers: int, *, keep_all: bool, depth: int, limit_bytes: int = 1 << 40
    ) -> None:
        self.clock = Clock()
        self.history = WriterHistory(
            depth, limit_bytes, keep_all=keep_all, side=self, now_ns=self.clock
        )
        self.names = [bytes([n]) * 16 for n in range(readers)]
        self.topic: dict[bytes, list[tuple[int, bytes]]] = {name: [] for name in self.names}
        self.control: list[tuple[str, bytes, Any]] = []
        self.proxies: dict[bytes, WriterProxy] = {}
        self.heard: dict[bytes, list[int]] = {name: [] for name in self.names}
        self.full: dict[bytes, list[tuple[int, WriterProxy]]] = {name: [] for name in self.names}
        self.room = dict.fromkeys(self.names, True)
        self.lost_count = 0
        self.muted: list[bytes] = []
        self.refusals: list[int] = []
        self.beginnings: list[int] = []
        self.number = 0
        for name in self.names:
            self.history.add(name, name.hex())

    def publish(self, size: int = 10) -> None:
        """Write one message."""
        self.number += 1
        self.history.write(self.number, self.number.to_bytes(size, "big"), b"")

    # What the writer does

    def put(self, payload: bytes, extra: bytes) -> None:
        """Send to all who are there."""
        assert extra == b""
        for name in self.names:
            reader = self.history.readers.get(name)
            if reader is not None and not reader.away_until_ns:
                self.topic[name].append((int.from_bytes(payload, "big"), payload))

    def resend(self, reader: ReaderProxy, entry: Any) -> None:
        """Send again."""
        self.control.append(("data", reader.gid, entry))

    def heartbeat(self, reader: ReaderProxy, first: int, last: int) -> None:
        """Tell how far it goes."""
        self.control.append(("heartbeat", reader.gid, (first, last)))

    def gap(self, reader: ReaderProxy, first: int, last: int) -> None:
        """Tell what will not come."""
        self.control.append(("gap", reader.gid, (first, last)))

    def mute(self, reader: ReaderProxy) -> None:
        """Record."""
        self.muted.append(reader.gid)

    def lost(self, count: int) -> None:
        """Count."""
        self.lost_count += count

    # What readers do

    def accept(self, item: Any, proxy: WriterProxy) -> bool:
        """Take a message, or keep it waiting without room."""
        name = proxy.gid
        if self.full[name] or not self.room[name]:
            self.full[name].append((item, proxy))
            return False
        self.heard[name].append(item)
        return True

    def acknack(self, proxy: WriterProxy, first: int, ranges: list[tuple[int, int]]) -> None:
        """Answer."""
        self.control.append(("acknack", proxy.gid, (first, ranges)))

    def refused(self, proxy: WriterProxy, last: int) -> None:
        """Count."""
        self.refusals.append(last)

    def started_anew(self, proxy: WriterProxy, first: int) -> None:
        """Count."""
        self.beginnings.append(first)

    def make_room(self, name: bytes) -> None:
        """Use what waits."""
        self.room[name] = True
        while self.full[name]:
            item, proxy = self.full[name].pop(0)
            self.heard[name].append(item)
            proxy.used(10)

    # The way between

    def bring_topic(self, name: bytes, *, lose: bool = False) -> None:
        """Let the next message arrive, or not."""
        if self.topic[name]:
            number, payload = self.topic[name].pop(0)
            proxy = self.proxies.get(name)
            if not lose and proxy is not None:
                free = self.room[name] and not self.full[name]
                if free and number == proxy.expected:
                    self.heard[name].append(number)
                    proxy.note_in_order(len(payload))
                else:
                    proxy.take(number, number, len(payload))

    def bring_control(self, index: int = 0, *, lose: bool = False) -> None:
        """Let one of the rest arrive, or not."""
        if not self.control:
            return
        kind, name, what = self.control.pop(index % len(self.control))
        if lose:
            return
        if kind == "acknack":
            self.history.acknack(name, *what)
        elif kind == "heartbeat":
            if name not in self.proxies:
                self.proxies[name] = WriterProxy(name, "", what[0], self, self.clock)
            self.proxies[name].heartbeat(*what)
        elif name in self.proxies:
            if kind == "gap":
                self.proxies[name].gap(*what)
            else:
                proxy = self.proxies[name]
                proxy.take(what.sequence, what.sequence, len(what.payload), is_resent=True)

    def settle(self) -> None:
        """Bring everything, and let time pass, until nothing happens any more."""
        for _ in range(10_000):
            for name in self.names:
                while self.topic[name]:
                    self.bring_topic(name)
            while self.control:
                self.bring_control()
            self.clock.ns += 60_000_000
            if not self.history.tick() and not self.control:
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
    """The promise itself, in any order of events."""
    wire = Wire(readers, keep_all=keep_all, depth=100_000)
    for move, which, index in moves:
        name = wire.names[which % readers]
        if move <= 2:
            for _ in range(index + 1):
                wire.publish()
        elif move <= 4:
            wire.bring_topic(name, lose=move == 4)
        elif move <= 6:
            wire.bring_control(index, lose=move == 6)
        elif move == 7:
            wire.room[name] = False
        elif move == 8:
            wire.make_room(name)
        else:
            wire.clock.ns += 30_000_000
            wire.history.tick()
    for name in wire.names:
        wire.make_room(name)
    wire.settle()
    everything = list(range(1, wire.number + 1))
    assert all(heard == everything for heard in wire.heard.values())
    assert wire.lost_count == 0
    assert wire.history.done


@given(
    depth=st.integers(1, 5),
    moves=st.lists(st.tuples(st.integers(0, 6), st.integers(0, 7)), max_size=150),
)
def test_what_the_depth_drops_is_counted_and_the_rest_arrives_in_order(
    depth: int, moves: list[tuple[int, int]]
) -> None:
    """One reader: what it did not hear was counted, and the last `depth` are there.

    One more may be counted that is being sent again just when it is dropped.
    """
    wire = Wire(1, keep_all=False, depth=depth)
    (name,) = wire.names
    for move, index in moves:
        if move <= 2:
            wire.publish(200_000 if index == 7 else 10)
        elif move <= 4:
            wire.bring_topic(name, lose=move == 4)
        elif move == 5:
            if not wire.topic[name]:  # nothing overtakes messages on their way
                wire.bring_control(index)
        else:
            wire.clock.ns += 30_000_000
            wire.history.tick()
    wire.settle()
    heard = wire.heard[name]
    assert heard == sorted(set(heard))
    assert set(range(max(1, wire.number - depth + 1), wire.number + 1)) <= set(heard)
    assert wire.number - len(heard) <= wire.lost_count


def test_numbers_that_went_another_way_are_not_waited_for() -> None:
    """A publisher leaves Zenoh while links carry everything, and comes back."""
    wire = Wire(1, keep_all=True, depth=100)
    wire.publish()
    wire.number += 50
    wire.publish()
    wire.settle()
    assert wire.heard[wire.names[0]] == [1, 52]
    assert wire.lost_count == 0


def test_a_gap_of_any_length_is_told_in_one_word() -> None:
    """A publisher that was on a link for days comes back to Zenoh."""
    wire = Wire(1, keep_all=True, depth=100)
    wire.settle()
    wire.publish()
    wire.number += 10**12
    wire.publish()
    wire.control.clear()  # the word is lost, and asked for again
    wire.settle()
    assert wire.heard[wire.names[0]] == [1, 10**12 + 2]


def test_a_writer_sends_a_window_ahead_and_no_more() -> None:
    """So that nothing on the way to a frozen reader ever fills up."""
    wire = Wire(1, keep_all=True, depth=1000)
    for _ in range(900):
        wire.publish(10_000)
    assert 40 <= len(wire.topic[wire.names[0]]) <= 60
    assert wire.history.has_room()
    for _ in range(100):
        wire.publish(10_000)
    assert not wire.history.has_room()
    wire.settle()
    assert wire.heard[wire.names[0]] == list(range(1, 1001))


def test_what_was_dropped_before_it_was_sent_does_not_fill_the_window() -> None:
    """Else a publisher of large messages stands still for good after its reader lagged once."""
    wire = Wire(1, keep_all=False, depth=1)
    for _ in range(20):
        wire.publish(200_000)
    wire.topic[wire.names[0]].clear()
    wire.settle()
    assert wire.heard[wire.names[0]] == [20]
    assert wire.lost_count == 19


@pytest.mark.parametrize("acknowledges", [True, False])
def test_what_waits_for_a_frozen_reader_is_sent_to_a_new_one(*, acknowledges: bool) -> None:
    """No acknowledgement opens the window then."""
    wire = Wire(1, keep_all=False, depth=1000)
    topic = wire.topic[wire.names[0]]
    for _ in range(100):
        wire.publish(10_000)
    waiting = len(topic)
    if acknowledges:
        wire.history.add(b"n" * 16, "")
    else:
        wire.history.has_other_readers = True
    wire.publish(10_000)
    assert len(topic) > waiting


def test_a_lagging_reader_holds_up_no_other_of_a_keep_last_writer() -> None:
    """One laptop that left the network must not silence the robot."""
    wire = Wire(2, keep_all=False, depth=10)
    slow, quick = wire.names
    for _ in range(500):
        wire.publish(10_000)
        while wire.topic[quick]:
            wire.bring_topic(quick)
        while any(each[1] == quick for each in wire.control):
            wire.bring_control([each[1] for each in wire.control].index(quick))
    assert wire.heard[quick] == list(range(1, 501))
    wire.topic[slow].clear()
    wire.settle()
    assert wire.heard[slow] == list(range(491, 501))
    assert wire.lost_count == 490


@pytest.mark.parametrize("back", [True, False])
def test_the_place_of_a_reader_that_vanished_silently_is_kept_for_a_while(*, back: bool) -> None:
    """It was frozen for longer than its lease: KEEP_ALL is complete when it comes back."""
    wire = Wire(1, keep_all=True, depth=1000)
    (name,) = wire.names
    wire.bring_control()
    wire.bring_control()  # its answer
    wire.publish()
    wire.clock.ns += 10_000_000_000
    wire.history.remove(name)
    wire.topic[name].clear()
    for _ in range(50):
        wire.publish()
    assert not wire.history.done
    if back:
        wire.history.add(name, "")
        wire.settle()
        assert wire.heard[name] == list(range(1, 52))
        assert wire.lost_count == 0
    else:
        wire.clock.ns += RETURN_NS
        wire.history.tick()
        assert wire.history.done
        assert wire.lost_count == 51  # type: ignore[unreachable]


def test_nothing_is_kept_for_a_reader_that_vanished_without_any_answer() -> None:
    """Any program may announce a subscription; a reader of aionode answers at once."""
    wire = Wire(1, keep_all=True, depth=1000)
    for _ in range(50):
        wire.publish()
    wire.clock.ns += 10_000_000_000

    wire.history.remove(wire.names[0])

    assert wire.history.done


def test_a_keep_all_writer_has_no_room_beyond_its_bytes() -> None:
    """Ten thousand messages for a reader that never answers are gigabytes if they are large."""
    wire = Wire(1, keep_all=True, depth=10_000, limit_bytes=100_000)
    count = 0
    while wire.history.has_room():
        wire.publish(10_000)
        count += 1

    assert 10 <= count <= 12
    wire.settle()
    assert wire.history.has_room()


def test_a_keep_last_writer_drops_its_oldest_beyond_its_bytes() -> None:
    """And counts them, like those beyond its depth."""
    wire = Wire(1, keep_all=False, depth=10_000, limit_bytes=1_000_000)
    (name,) = wire.names
    for _ in range(1_000):
        wire.publish(10_000)

    size_bytes = sum(len(entry[1]) for entry in wire.history.entries)
    assert 900_000 < size_bytes <= 1_000_000
    wire.settle()
    assert wire.history.done
    assert len(wire.heard[name]) + wire.lost_count == 1_000


def test_one_message_is_kept_whatever_its_size() -> None:
    """A limit is no limit of the size of a message."""
    wire = Wire(1, keep_all=False, depth=10, limit_bytes=100)
    wire.publish(10_000)
    wire.settle()

    assert wire.heard[wire.names[0]] == [1]


def test_a_reader_holds_few_bytes_while_a_message_is_missing() -> None:
    """A writer that leaves out one number, and goes on, must not fill the memory of its readers."""
    wire = Wire(1, keep_all=True, depth=10_000)
    (name,) = wire.names
    wire.bring_control()
    proxy = wire.proxies[name]

    for number in range(2, 1_000):
        proxy.take(number, number, 100_000)

    assert wire.heard[name] == []
    proxy.take(1, 1, 100_000)
    assert wire.heard[name] == list(range(1, 12))  # a megabyte was held, the rest comes again


def test_a_reader_that_answered_just_now_has_ended_when_it_vanishes() -> None:
    """A killed process must not hold up a KEEP_ALL publisher."""
    wire = Wire(1, keep_all=True, depth=1000)
    for _ in range(10):
        wire.publish()
    wire.clock.ns += 1_000_000_000
    wire.history.remove(wire.names[0])
    assert wire.history.done
    assert wire.lost_count == 0


@pytest.mark.parametrize("answers", [True, False])
def test_an_idle_keep_all_writer_knows_whether_a_vanished_reader_was_frozen(
    *, answers: bool
) -> None:
    """It has acknowledged everything, so only a probe tells a frozen reader from a killed one."""
    wire = Wire(1, keep_all=True, depth=1000)
    (name,) = wire.names
    wire.publish()
    wire.settle()
    for _ in range(10):
        wire.clock.ns += 1_000_000_000
        assert wire.history.probe()
        if answers:
            wire.settle()
        wire.control.clear()
    wire.history.remove(name)
    assert (name in wire.history.readers) is not answers
    wire.publish()
    wire.topic[name].clear()
    if not answers:
        wire.history.add(name, "")
        wire.settle()
        assert wire.heard[name] == [1, 2]
    assert wire.history.done
    assert wire.lost_count == 0


def test_a_reader_that_answers_anyway_is_not_probed() -> None:
    """A probe is for silence: a busy publisher sends none."""
    wire = Wire(1, keep_all=True, depth=1000)
    wire.publish()
    wire.settle()
    assert wire.history.probe()
    assert not wire.control
    wire.history.remove(wire.names[0])
    assert not wire.history.probe()


def test_a_heavy_loss_is_made_good_without_sending_much_twice() -> None:
    """A storm of repetitions would make congestion worse."""
    wire = Wire(1, keep_all=False, depth=20_000)
    (name,) = wire.names
    dice = random.Random(1)  # noqa: S311  # the same each time
    resent = 0
    for _ in range(5_000):
        wire.publish(100)
    for _ in range(5_000):
        wire.bring_topic(name, lose=dice.random() < 0.3)
        wire.clock.ns += 50_000
        while wire.control:
            resent += wire.control[0][0] == "data"
            wire.bring_control()
    wire.settle()
    assert wire.heard[name] == list(range(1, 5_001))
    assert resent < 3_000


def test_a_reader_that_vanishes_again_soon_after_its_return_misses_nothing() -> None:
    """Connections are cut and made anew for a while after a process was frozen."""
    wire = Wire(1, keep_all=True, depth=1000)
    (name,) = wire.names
    wire.settle()
    wire.publish()
    wire.clock.ns += 10_000_000_000
    wire.history.remove(name)
    wire.topic[name].clear()
    wire.publish()
    for is_heard in (False, True):
        wire.history.add(name, "")
        if is_heard:
            wire.settle()
        wire.clock.ns += 1_000_000_000
        wire.history.remove(name)
        wire.topic[name].clear()
        wire.publish()
    wire.history.add(name, "")
    wire.settle()
    assert wire.heard[name] == [1, 2, 3, 4]
    assert wire.lost_count == 0


def test_a_reader_that_ends_soon_after_its_return_holds_nothing_up_for_long() -> None:
    """It is not waited for as long as one that was silent before it vanished."""
    wire = Wire(1, keep_all=True, depth=1000)
    (name,) = wire.names
    wire.settle()
    wire.publish()
    wire.clock.ns += 10_000_000_000
    wire.history.remove(name)
    wire.history.add(name, "")
    wire.settle()
    wire.history.remove(name)
    wire.publish()
    assert not wire.history.done
    wire.clock.ns += FLAPPING_NS
    wire.history.tick()
    assert wire.history.done


def test_the_stop_of_a_lease_waits_for_no_window() -> None:
    """What waits before it is dropped and counted; the reader gets the rest, and the stop last."""
    wire = Wire(1, keep_all=False, depth=1000)
    (name,) = wire.names
    for _ in range(20):
        wire.publish(WINDOW_BYTES // 4)
    assert wire.history.unsent
    sent = len(wire.topic[name])
    wire.number += 1

    wire.history.write_stop(wire.number, wire.number.to_bytes(10, "big"), b"", wire.put)

    assert [number for number, _ in wire.topic[name]] == [*range(1, sent + 1), wire.number]
    assert wire.lost_count == 20 - sent
    wire.settle()
    assert wire.heard[name] == [*range(1, sent + 1), wire.number]


def test_a_stop_that_was_sent_already_is_sent_again_only_to_those_who_lack_it() -> None:
    """Another thread has sent it; here it enters the history."""
    wire = Wire(1, keep_all=False, depth=10)
    (name,) = wire.names
    wire.publish()

    wire.history.write_stop(2, (2).to_bytes(10, "big"), b"", lambda _payload, _extra: None)

    assert [number for number, _ in wire.topic[name]] == [1]
    wire.settle()
    assert wire.heard[name] == [1, 2]
    wire.number = 2
    wire.publish()
    wire.settle()
    assert wire.heard[name] == [1, 2, 3]


# HEARTBEAT and GAP in the writer's name

FAR = 2**62


def hear(wire: Wire, count: int) -> None:
    """Publish some messages, which arrive at the only reader."""
    for _ in range(count):
        wire.publish()
        wire.bring_topic(wire.names[0])


@pytest.mark.parametrize("ahead", [1, 50, 4_000, 5_000, FAR])
@pytest.mark.parametrize("kind", ["heartbeat", "gap"])
def test_what_is_said_in_a_writers_name_makes_its_reader_miss_nothing(
    kind: str, ahead: int
) -> None:
    """Neither a little ahead of what has come, nor so far that the topic were silent for good."""
    wire = Wire(1, keep_all=False, depth=10)
    (name,) = wire.names
    wire.bring_control()
    hear(wire, 10)
    for _ in range(3):
        lie = {"heartbeat": (10 + ahead, FAR), "gap": (1, 10 + ahead)}[kind]
        wire.control.append((kind, name, lie))
        wire.bring_control(-1)
        hear(wire, 10)
    wire.settle()

    assert wire.heard[name] == list(range(1, 41))
    assert wire.history.done
    assert wire.proxies[name].expected == 41


@given(
    moves=st.lists(
        st.tuples(st.integers(0, 5), st.integers(-3, 8), st.sampled_from([0, 5, 4_000, 5_000])),
        max_size=60,
    )
)
def test_whatever_is_said_in_a_writers_name_each_message_that_comes_is_taken_in_order(
    moves: list[tuple[int, int, int]],
) -> None:
    """Lies beside a stream of which nothing is lost on the way."""
    wire = Wire(1, keep_all=True, depth=100_000)
    (name,) = wire.names
    wire.bring_control()
    for move, near, far in moves:
        number = wire.number + near + far
        if move <= 1:
            wire.publish()
        elif move == 2:
            wire.bring_topic(name)
        elif move == 3:
            wire.control.append(("heartbeat", name, (number, number + near)))
        elif move == 4:
            wire.control.append(("gap", name, (number - 10, number)))
        else:
            wire.bring_control()
    wire.settle()

    assert wire.heard[name] == list(range(1, wire.number + 1))
    assert wire.lost_count == 0


def test_a_claim_beyond_what_was_sent_is_refused_and_told() -> None:
    """The next true HEARTBEAT contradicts it."""
    wire = Wire(1, keep_all=False, depth=10)
    (name,) = wire.names
    wire.bring_control()
    hear(wire, 3)
    wire.proxies[name].heartbeat(FAR, FAR)
    wire.control.clear()
    wire.publish()
    wire.settle()

    assert wire.refusals == [FAR]
    assert wire.heard[name] == [1, 2, 3, 4]


def test_a_reader_believes_how_far_its_writer_came_while_it_was_stopped() -> None:
    """A true claim: the message at its end is sent when it is asked for."""
    wire = Wire(2, keep_all=False, depth=10)
    slow, quick = wire.names
    for _ in range(20_000):
        wire.publish()
        wire.bring_topic(quick)
        while any(each[1] == quick for each in wire.control):
            wire.bring_control([each[1] for each in wire.control].index(quick))
    wire.topic[slow].clear()
    wire.settle()

    assert wire.heard[slow] == list(range(19_991, 20_001))
    assert wire.lost_count == 19_990
    assert wire.refusals == []
    assert wire.beginnings == []


@pytest.mark.parametrize("far", [1, 5_000])
def test_a_gap_of_numbers_that_went_another_way_needs_no_answer(far: int) -> None:
    """The message after it shows that it is true; a filter may hold back very many."""
    wire = Wire(1, keep_all=True, depth=100)
    (name,) = wire.names
    wire.bring_control()
    hear(wire, 1)
    wire.control.clear()
    wire.number += far
    wire.publish()
    wire.bring_control()
    wire.bring_topic(name)

    assert wire.heard[name] == [1, far + 2]


def test_a_lie_does_not_keep_a_writer_from_learning_that_everything_arrived() -> None:
    """It would wait at its end for an acknowledgement of no more than it has sent."""
    wire = Wire(1, keep_all=True, depth=10)
    (name,) = wire.names
    wire.bring_control()
    hear(wire, 1)
    wire.control.append(("heartbeat", name, (10, 14)))
    wire.settle()

    assert wire.history.done


def test_a_first_heartbeat_that_lies_costs_no_message() -> None:
    """Nothing else says where a stream begins for a reader, so it is believed until one comes."""
    wire = Wire(1, keep_all=False, depth=10)
    (name,) = wire.names
    wire.control.insert(0, ("heartbeat", name, (FAR, FAR)))
    wire.bring_control()
    hear(wire, 5)
    wire.settle()

    assert wire.heard[name] == [1, 2, 3, 4, 5]
    assert wire.beginnings == [1]


def test_a_reader_that_gets_only_messages_far_below_what_it_expects_starts_anew() -> None:
    """Whoever may publish the topic can send a wrong number as a message; that heals as well."""
    wire = Wire(1, keep_all=False, depth=10)
    (name,) = wire.names
    wire.bring_control()
    hear(wire, 5)
    proxy = wire.proxies[name]
    for number in range(1_000_000, 1_000_002):
        proxy.heartbeat(number, number)
        proxy.take(number, number, 10)
    for _ in range(30):
        hear(wire, 1)
        wire.clock.ns += 100_000_000

    assert wire.heard[name] == [1, 2, 3, 4, 5, 1_000_000, 1_000_001, *range(21, 36)]
    assert wire.beginnings == [21]


def test_messages_that_were_only_overtaken_do_not_begin_a_stream_anew() -> None:
    """A burst of old ones, or those that were sent again, would be heard out of order."""
    wire = Wire(1, keep_all=False, depth=10)
    (name,) = wire.names
    wire.bring_control()
    hear(wire, 5)
    proxy = wire.proxies[name]
    proxy.take(1_000_000, 1_000_000, 10)
    proxy.heartbeat(1_000_000, 1_000_000)
    proxy.take(1_000_001, 1_000_001, 10)
    heard = list(wire.heard[name])
    for number in range(6, 100):
        proxy.take(number, number, 10)
    for number in range(100, 200):
        wire.clock.ns += 100_000_000
        proxy.take(number, number, 10, is_resent=True)

    assert wire.heard[name] == heard


def test_readers_that_never_answer_are_asked_a_few_at_a_time() -> None:
    """Anybody can announce thousands: to ask all at once would stop the event loop."""
    wire = Wire(1, keep_all=False, depth=10)
    hear(wire, 1)
    wire.settle()
    for number in range(1, 51):
        wire.history.add(number.to_bytes(16, "big"), "liar")
    (name,) = wire.names
    wire.publish()
    asked = []
    for _ in range(10):
        wire.control.clear()
        wire.clock.ns += HEARTBEAT_NS // 10
        wire.history.tick()
        asked.append([to for kind, to, _ in wire.control if kind == "heartbeat"])

    assert max(map(len, asked)) <= UNANSWERED_EACH_TICK + 1
    assert name in {each for some in asked for each in some}
    assert len({each for some in asked for each in some}) == 51


@pytest.mark.parametrize("keep_all", [True, False])
def test_a_reader_that_never_answers_is_waited_for_some_seconds_only(*, keep_all: bool) -> None:
    """Any program may announce it, and say that it acknowledges; the others get everything."""
    wire = Wire(2, keep_all=keep_all, depth=10_000)
    liar, name = wire.names
    wire.control = [each for each in wire.control if each[1] != liar]
    count = 2 * WINDOW_BYTES // 1000
    for _ in range(count):
        wire.publish(1000)
    held_at = []
    for _ in range(MUTE_TICKS + 1):
        while wire.topic[name]:
            wire.bring_topic(name)
        wire.control = [each for each in wire.control if each[1] != liar]
        while wire.control:
            wire.bring_control()
        held_at.append(len(wire.heard[name]))
        wire.clock.ns += 60_000_000
        wire.history.tick()
    wire.settle()

    assert (held_at[-2] < count) is keep_all
    assert wire.muted == [liar]
    assert wire.heard[name] == list(range(1, count + 1))
    assert wire.lost_count >= 512 * 1024 // 1200
    assert liar not in wire.history.readers
    assert wire.history.done


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
        wire.history.tick()

    assert wire.muted == []
    assert not wire.history.done
