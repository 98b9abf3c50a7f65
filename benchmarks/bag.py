"""Bags: the writer beside those of `mcap` and `rosbags`, and a recorder under load.

    python benchmarks/bag.py writers
    python benchmarks/bag.py recorder --seconds 30 [--image]

Ratios are comparable between machines; absolute times are not. `recorder` says, topic by topic in
sum, what was published, recorded and lost, how much of a processor it took, and the longest gap of
the event loop beside that of the same publishers without a recorder.
"""

from __future__ import annotations

import argparse
import asyncio
import gc
import os
import shutil
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from mcap.writer import CompressionType
from mcap.writer import Writer as McapLibraryWriter
from rosbags.rosbag2 import StoragePlugin
from rosbags.rosbag2 import Writer as RosbagsWriter
from rosbags.typesys import Stores, get_typestore

from aionode import bag
from aionode.bag._writer import topic_info
from aionode.context import Context
from aionode.interfaces.sensor_msgs.msg import Image
from aionode.interfaces.std_msgs.msg import String
from aionode.node import Node

TOPICS = 20
RATE_HZ = 1000
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


async def publish(seconds: float, *, image: bool, folder: Path | None) -> dict[str, Any]:
    """Publish for some seconds, with a recorder or without, and return what was seen."""
    gaps: list[float] = []
    text = "x" * 1000
    picture = Image(data=LARGE)
    async with Context(transport="local") as context, Node("load", context=context) as node:
        publishers = [node.create_publisher(String, f"t{n}", 1000) for n in range(TOPICS)]
        camera = node.create_publisher(Image, "image", 10)
        recorder = bag.Recorder(folder, context=context) if folder is not None else None
        if recorder is not None:
            await recorder.__aenter__()
        loop = asyncio.get_running_loop()
        cpu, began = time.process_time(), loop.time()
        done = pictures = 0
        last = began
        while (now := loop.time()) < began + seconds:
            gaps.append(now - last)
            last = now
            due = int((now - began) * RATE_HZ)
            while done < due:
                done += 1
                for publisher in publishers:
                    publisher.publish(String(data=text))
                if done % 10 == 0:
                    break
            if image and now - began > pictures / 30:
                pictures += 1
                camera.publish(picture)
            await asyncio.sleep(0.001)
        cpu = time.process_time() - cpu
        seen: dict[str, Any] = {"gap_ms": max(gaps) * 1e3, "cpu": cpu / seconds, "sent": done}
        if recorder is not None:
            await asyncio.sleep(0.2)
            seen["stats"] = recorder.stats
            await recorder.__aexit__(None, None, None)
    return seen


def measure_recorder(seconds: float, *, image: bool) -> None:
    """Print what a recorder records and costs."""
    control = asyncio.run(publish(seconds, image=image, folder=None))
    folder = Path(tempfile.mkdtemp(prefix="bag-benchmark-"))
    seen = asyncio.run(publish(seconds, image=image, folder=folder / "run"))
    with bag.open(folder / "run") as run:
        counts = run.counts
    wrong = [
        name
        for name in (f"/t{n}" for n in range(TOPICS))
        if counts[name] + sum(seen["stats"][name][1:]) != seen["sent"]
    ]
    lost = sum(sum(each[1:]) for each in seen["stats"].values())
    size = sum(file.stat().st_size for file in (folder / "run").iterdir())
    print(f"load {os.getloadavg()[0]:.1f}; {TOPICS} topics, {seen['sent']} messages of each")
    print(f"recorded {sum(counts.values())}, lost {lost}; topics that do not add up: {wrong}")
    print(f"processor: {seen['cpu']:.2f} of a core, {control['cpu']:.2f} without the recorder")
    print(f"longest gap: {seen['gap_ms']:.1f} ms, {control['gap_ms']:.1f} ms without")
    print(f"{size / 1e6 / seconds:.1f} MB a second on the disk")
    shutil.rmtree(folder)


def main() -> None:
    """Run what the command line names."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("what", choices=["writers", "recorder"])
    parser.add_argument("--seconds", type=float, default=30.0)
    parser.add_argument("--image", action="store_true", help="with 6 MB images at 30 Hz")
    given = parser.parse_args()
    if given.what == "writers":
        compare_writers()
    else:
        measure_recorder(given.seconds, image=given.image)


if __name__ == "__main__":
    main()
