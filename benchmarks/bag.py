"""Bags: the writer compared with those of `mcap` and `rosbags`, and a recorder under load.

    python benchmarks/bag.py writers
    python benchmarks/bag.py recorder --seconds 30

Ratios are comparable between machines; absolute times are not. `recorder` compares, topic by topic,
the published messages with those in the bag and with the losses that the recorder reports. It
prints the share of a processor that recording takes, the longest stall of the event loop compared
with that of the same publishers without a recorder, and how late a player of the bag publishes,
each with a verdict.
"""

from __future__ import annotations

import argparse
import asyncio
import gc
import os
import shutil
import tempfile
import time
from collections.abc import Callable, Coroutine
from contextlib import AsyncExitStack
from pathlib import Path
from typing import NamedTuple, TypeVar

from mcap.writer import CompressionType
from mcap.writer import Writer as McapLibraryWriter
from rosbags.rosbag2 import StoragePlugin
from rosbags.rosbag2 import Writer as RosbagsWriter
from rosbags.typesys import Stores, get_typestore

from aionode import bag
from aionode.bag._writer import topic_info
from aionode.clock import MachineTime
from aionode.engine.context import Context
from aionode.interfaces.sensor_msgs.msg import Image
from aionode.interfaces.std_msgs.msg import String
from aionode.node import Node
from aionode.runner import best_loop_factory

T = TypeVar("T")
perf_ns = MachineTime().steady_ns

TOPICS = 20
RATE_HZ = 1000
IMAGE_HZ = 30
SMALL = [os.urandom(500).hex().encode() for _ in range(64)]  # 1 kB, of which half is random
LARGE = os.urandom(6_000_000)


def ours(folder: Path, messages: list[bytes], compression: str = "zstd") -> None:
    """Write messages with `BagWriter`."""
    with bag.BagWriter(folder / "ours", compression=compression) as out:
        number = out.add_topic(topic_info("/x", String))
        for at, raw in enumerate(messages):
            out.write(number, at + 1, raw)


def library(folder: Path, messages: list[bytes]) -> None:
    """Write messages with the library `mcap`."""
    with (folder / "x.mcap").open("wb") as stream:
        out = McapLibraryWriter(stream, compression=CompressionType.ZSTD)
        out.start("ros2")
        schema = out.register_schema("std_msgs/msg/String", "ros2msg", b"string data\n")
        channel = out.register_channel("/x", "cdr", schema)
        for at, raw in enumerate(messages):
            out.add_message(channel, at + 1, raw, at + 1)
        out.finish()  # type: ignore[no-untyped-call]  # of the library


def rosbags(folder: Path, messages: list[bytes]) -> None:
    """Write messages with the library `rosbags`, without compression."""
    store = get_typestore(Stores.ROS2_JAZZY)
    with RosbagsWriter(folder / "r", version=9, storage_plugin=StoragePlugin.MCAP) as out:
        topic = out.add_connection("/x", "std_msgs/msg/String", typestore=store)
        for at, raw in enumerate(messages):
            out.write(topic, at + 1, raw)


def cpu_of(write: Callable[[Path, list[bytes]], None], messages: list[bytes]) -> float:
    """Return the processor time of a writer for each message in µs, the best of three."""
    best = float("inf")
    for _ in range(3):
        folder = Path(tempfile.mkdtemp(prefix="bag-benchmark-"))
        gc.collect()
        began = time.process_time()
        write(folder, messages)
        best = min(best, time.process_time() - began)
        shutil.rmtree(folder)
    return best / len(messages) * 1e6


def compare_writers() -> None:
    """Print the cost of each writer, and the ratio to ours."""
    small = [SMALL[at % len(SMALL)] for at in range(50_000)]
    for name, messages in (("1 kB", small), ("6 MB", [LARGE] * 12)):
        base = cpu_of(ours, messages)
        print(f"{name}: aionode {base:.1f} µs of processor time for each message")
        writers = {"mcap (zstd)": library, "rosbags (no compression)": rosbags}
        for other, write in writers.items():
            cost = cpu_of(write, messages)
            print(f"{name}: {other} {cost:.1f} µs, {cost / base:.2f} times as much")


class Seen(NamedTuple):
    """The measurements of one run.

    Attributes:
        sent: How many messages each topic was given.
        cpu: How much of a processor the whole process took, all threads together.
        gap_ms: The longest time between two turns of the event loop, with the publishing in it.
        stats: What the recorder says of each topic.
    """

    sent: int
    cpu: float
    gap_ms: float
    stats: dict[str, bag.TopicStats]


def perf_s() -> float:
    """Return the steady time in seconds; uvloop's own clock only has whole milliseconds."""
    return perf_ns() / 1e9


async def publish(seconds: float, *, image: bool, folder: Path | None) -> Seen:
    """Publish for some seconds, with or without a recorder, and return the measurements."""
    texts = [each.decode() for each in SMALL]
    picture = Image(data=LARGE)
    async with Context(transport="local") as context, Node("load", context=context) as node:
        publishers = [node.create_publisher(String, f"t{n}", 1000) for n in range(TOPICS)]
        camera = node.create_publisher(Image, "image", 10)
        wanted = [f"/t{n}" for n in range(TOPICS)] + ["/image"]
        async with AsyncExitStack() as stack:
            recorder = None
            if folder is not None:
                recorder = bag.Recorder(folder, topics=wanted, context=context)
                await stack.enter_async_context(recorder)
            gc.collect()
            cpu, began = time.process_time(), perf_s()
            sent = pictures = 0
            gap, last = 0.0, began
            while (now := perf_s()) < began + seconds:
                gap, last = max(gap, now - last), now
                due = int((now - began) * RATE_HZ)
                if image and now - began > pictures / IMAGE_HZ:
                    pictures += 1
                    camera.publish(picture)
                for _ in range(min(due - sent, 5)):
                    sent += 1
                    for publisher in publishers:
                        publisher.publish(String(data=texts[sent % len(texts)]))
                await asyncio.sleep(0.001 if sent >= due else 0)
            cpu = (time.process_time() - cpu) / seconds
            await asyncio.sleep(0.2)
            if recorder is not None:
                await recorder.stop()
            stats = {} if recorder is None else recorder.stats
    return Seen(sent, cpu, gap * 1e3, stats)


def verdict(text: str, *, holds: bool) -> None:
    """Print a figure, and whether it is as it should be."""
    print(f"{'holds' if holds else 'FAILS'}: {text}", flush=True)


def measure_recorder(seconds: float) -> None:
    """Print what a recorder records and costs, and whether that is as promised."""
    folder = Path(tempfile.mkdtemp(prefix="bag-benchmark-"))
    print(
        f"{TOPICS} topics of {RATE_HZ} Hz, 1 kB each, {seconds:g} s; load {os.getloadavg()[0]:.1f}"
    )
    control = run(publish(seconds, image=False, folder=None))
    seen = run(publish(seconds, image=False, folder=folder / "run"))
    with bag.open(folder / "run") as opened:
        counts = opened.counts
    wrong = [
        name
        for name, each in seen.stats.items()
        if name != "/image"
        and seen.sent != counts[name] + each.lost_in_transport + each.lost_in_recorder
    ]
    lost = sum(each.lost_in_transport + each.lost_in_recorder for each in seen.stats.values())
    size = sum(file.stat().st_size for file in (folder / "run").iterdir())
    total, recorded = seen.sent * TOPICS, sum(counts.values())
    wanted = int(seconds * RATE_HZ) * TOPICS
    verdict(
        f"published {total} of {wanted} wanted = recorded {recorded} + lost {lost}; "
        f"wrong topics: {wrong or 'none'}",
        holds=not wrong and total == recorded + lost,
    )
    verdict(f"lost {lost}, has to be 0 at a load up to 2", holds=lost == 0)
    verdict(
        f"processor: the recorder takes {seen.cpu - control.cpu:.0%} of a core, at most 35%; with "
        f"the publishers {seen.cpu:.0%}, which take {control.cpu:.0%} alone",
        holds=seen.cpu - control.cpu <= 0.35,
    )
    print(f"the disk got {size / 1e6 / seconds:.1f} MB a second")
    images = run(publish(seconds, image=True, folder=None))
    both = run(publish(seconds, image=True, folder=folder / "images"))
    lost = sum(each.lost_in_transport + each.lost_in_recorder for each in both.stats.values())
    verdict(
        f"with images of 6 MB at 30 Hz: longest gap {both.gap_ms:.1f} ms, {images.gap_ms:.1f} ms "
        f"without the recorder, may be 5 ms longer; lost {lost}, "
        f"{both.cpu - images.cpu:.0%} of a core",
        holds=both.gap_ms <= images.gap_ms + 5,
    )
    shutil.rmtree(folder / "images")
    measure_player(folder / "run")
    shutil.rmtree(folder)


def measure_player(path: Path) -> None:
    """Print how late a player publishes, compared with a task that only sleeps."""
    late, sleeper, count = run(play(path))
    player_ms, sleeper_ms = (p99(each) * 1e3 for each in (late, sleeper))
    verdict(
        f"play: p99 of {count} messages {player_ms:.2f} ms late, a bare sleeper beside it "
        f"{sleeper_ms:.2f} ms; may be 1 ms later",
        holds=player_ms <= sleeper_ms + 1,
    )


async def play(path: Path) -> tuple[list[float], list[float], int]:
    """Play a bag, and return the lateness of its messages and of a sleeper's wake-ups."""
    late: list[float] = []
    sleeper: list[float] = []
    loop = asyncio.get_running_loop()

    async def sleep() -> None:
        due = loop.time()
        while True:
            due = max(due + 0.001, loop.time())
            await asyncio.sleep(due - loop.time())
            sleeper.append(loop.time() - due)

    async with (
        Context(transport="local") as context,
        bag.Player(path, context=context, delay_sec=0.5) as player,
        asyncio.TaskGroup() as tasks,
    ):
        plain = player._publish  # noqa: SLF001  # to see when it publishes

        def publish(record: bag.Record) -> None:
            steady_ns, bag_ns = player._anchor or (0, 0)  # noqa: SLF001  # to see when it publishes
            late.append((perf_ns() - steady_ns - (record.time_ns - bag_ns)) / 1e9)
            plain(record)

        player._publish = publish  # type: ignore[method-assign]  # noqa: SLF001  # as above
        sleeping = tasks.create_task(sleep())
        await player.play()
        sleeping.cancel()
    return late, sleeper, player.played


def p99(values: list[float]) -> float:
    """Return the 99th percentile of some values."""
    return sorted(values)[int(len(values) * 0.99)]


def run(work: Coroutine[None, None, T]) -> T:
    """Run a coroutine in the event loop used by `aionode.run`."""
    with asyncio.Runner(loop_factory=best_loop_factory()) as runner:
        return runner.run(work)


def main() -> None:
    """Run the command given by the arguments."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("what", choices=["writers", "recorder"], nargs="?", default="writers")
    parser.add_argument("--seconds", type=float, default=30.0)
    given = parser.parse_args()
    if given.what == "writers":
        compare_writers()
    else:
        measure_recorder(given.seconds)


if __name__ == "__main__":
    main()
