"""One bag being written by a recorder: its topics, their statistics, and its thread."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Any, Final, NamedTuple

from aionode._process.concurrency import run_in_thread, to_the_end
from aionode.bag.files.losses import LOSSES, Lost, losses_text
from aionode.bag.recording.writer_thread import Row, WriterThread

if TYPE_CHECKING:
    from collections.abc import Callable, Collection, Mapping

    from aionode.bag._writer import BagWriter
    from aionode.bag.files.mcap_writer import Parts
    from aionode.bag.files.record import TopicInfo
    from aionode.endpoints.subscription import Subscription

__all__ = ["Key", "Recording", "TopicStats", "summary_of"]

Key = tuple[str, str, str]

MAX_LENT: Final = 32 << 20
"""Bytes that may wait for the disk in memory that other processes lend; beyond that, messages are
copied. A process lends only so much, and sends the rest at a higher cost.
"""


class TopicStats(NamedTuple):
    """What became of the messages of one topic.

    Attributes:
        recorded: How many are in the bag, or on their way to it.
        lost_in_transport: How many were published but did not arrive, judging by sequence numbers.
        lost_in_recorder: How many arrived but were not written.
    """

    recorded: int
    lost_in_transport: int
    lost_in_recorder: int


class Recording:
    """A bag that is being written by a thread.

    Args:
        writer: The bag.
        cache_bytes: How many bytes may wait for the disk; in snapshot mode, how many are kept.
        cache_ns: How long messages are kept in snapshot mode, in nanoseconds; 0 for no limit.
        snapshot: Whether to only keep messages until a snapshot is requested.
        on_failure: Called once, in the loop, when nothing can be written any more.

    Attributes:
        numbers: The ids of its topics, by name, type and hash.
        subscriptions: The sources of messages, by topic id; some topics have none.
        thread: The thread that writes.
    """

    def __init__(
        self,
        writer: BagWriter,
        *,
        cache_bytes: int,
        cache_ns: int,
        snapshot: bool,
        on_failure: Callable[[], None],
    ) -> None:
        self.numbers: dict[Key, int] = {}
        self.subscriptions: dict[int, Subscription[bytes]] = {}
        self._writer = writer
        self._keeps = snapshot
        self._topics: list[tuple[TopicInfo, int]] = []
        self._taken: list[int] = []
        self._refused: list[int] = []
        loop = asyncio.get_running_loop()
        self.thread = WriterThread(
            writer,
            self._topics,
            cache_bytes,
            cache_ns=cache_ns,
            snapshot=snapshot,
            on_failure=lambda: void(loop.call_soon_threadsafe(on_failure)),
            before_close=self._note_losses,
        )

    def number_of(self, info: TopicInfo, latched_depth: int) -> int:
        """Return the id of a topic, adding it if it is new."""
        number = self.numbers.get(info.key)
        if number is None:
            number = self.numbers[info.key] = len(self._topics)
            self._topics.append((info, latched_depth))
            self._taken.append(0)
            self._refused.append(0)
        return number

    def types_of(self, name: str) -> list[str]:
        """Return the types that a topic has in the bag."""
        return [info.type for info, _ in self._topics if info.name == name]

    def owned(self, topic: int, lent: memoryview) -> Parts:
        """Return a message in lent memory: a copy, unless it is written soon."""
        latched_depth = self._topics[topic][1]
        if self._keeps or latched_depth or self.thread.waiting_bytes > MAX_LENT:
            return bytes(lent)
        return [lent]

    def put(self, row: Row) -> None:
        """Pass a message to the thread; it is counted as lost if there is no room."""
        if self.thread.put(row):
            self._taken[row.topic] += 1
        else:
            self._refused[row.topic] += 1

    @property
    def stats(self) -> dict[str, TopicStats]:
        """The messages recorded and lost, by topic."""
        found: dict[str, TopicStats] = {}
        for number, (info, _) in enumerate(self._topics):
            subscription = self.subscriptions.get(number)
            transport = 0 if subscription is None else subscription.stats.lost
            not_written = self.thread.lost.get(number, 0)
            before = found.get(info.name, TopicStats(0, 0, 0))
            found[info.name] = TopicStats(
                before.recorded + self._taken[number] - not_written,
                before.lost_in_transport + transport,
                before.lost_in_recorder + self._refused[number] + not_written,
            )
        return found

    async def do(self, work: Callable[[], Any]) -> None:
        """Run something in the writer thread, after all earlier work, and wait for it.

        Raises:
            BagWriteError: the disk is full or fails.
        """
        loop = asyncio.get_running_loop()
        done: asyncio.Future[None] = loop.create_future()

        def finish() -> None:
            if not done.done():
                done.set_result(None)

        def run() -> None:
            try:
                work()
            finally:
                loop.call_soon_threadsafe(finish)

        self.thread.call(run)
        await done
        self.raise_failure()

    def raise_failure(self) -> None:
        """Raise the error that keeps the thread from writing, if there is one.

        Raises:
            BagWriteError: the disk is full or fails.
        """
        if self.thread.failure is not None:
            raise self.thread.failure

    async def close(self) -> None:
        """Write the rest, and close the bag; cancellation does not cut this short."""
        await to_the_end(run_in_thread(self.thread.stop))

    def annotate(self, key: str, value: str) -> None:
        """Add an entry to the metadata, which are written when the bag is closed."""
        self._writer.custom_data[key] = value

    def _note_losses(self) -> None:
        losses = {
            name: Lost(each.lost_in_transport, each.lost_in_recorder)
            for name, each in self.stats.items()
        }
        self._writer.custom_data[LOSSES] = losses_text(losses)


def summary_of(stats: Mapping[str, TopicStats], path: str, unrecorded: Collection[str]) -> str:
    """Summarize in one line what was recorded, lost, and not recorded at all."""
    recorded = sum(each.recorded for each in stats.values())
    lost = [
        f"{name}: {each.lost_in_transport} in transport, {each.lost_in_recorder} in recorder"
        for name, each in sorted(stats.items())
        if each.lost_in_transport or each.lost_in_recorder
    ]
    lost += [f"{name}: all, as no node describes its type" for name in sorted(unrecorded)]
    end = f"lost: {'; '.join(lost)}" if lost else "lost: nothing"
    return f"recorded {recorded} messages of {len(stats)} topics to {path}; {end}"


def void(_: object) -> None:
    """Return None, where a callback is required."""
