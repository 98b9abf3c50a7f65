"""Transforms: what a lookup costs compared with its arithmetic, and what pending waits cost.

Each figure is a ratio within one run, or a share of one processor, so that runs on different
machines can be compared: ``python benchmarks/tf.py``.
"""

from __future__ import annotations

import argparse
import asyncio
import time
import tracemalloc
from collections.abc import Callable
from contextlib import suppress
from functools import partial
from math import cos, sin

from aionode import Context, Node, Publisher, Time
from aionode.interfaces.builtin_interfaces.msg import Time as TimeMsg
from aionode.interfaces.geometry_msgs.msg import (
    PointStamped,
    Quaternion,
    Transform,
    TransformStamped,
    Vector3,
)
from aionode.interfaces.std_msgs.msg import Header
from aionode.interfaces.tf2_msgs.msg import TFMessage
from aionode.tf import Buffer, BufferCore
from aionode.tf._arithmetic import chained, unit
from aionode.tf._walk import walk

FRAMES = 50
WAITERS = 100
PER_MESSAGE = 10
RATE = 1000
"""Messages a second."""

EDGES = 5
SECOND = 10**9


def stamped(parent: str, child: str, stamp_ns: int) -> TransformStamped:
    """Return a transform that rotates slowly."""
    sec, nanosec = divmod(stamp_ns, SECOND)
    angle = stamp_ns / SECOND
    return TransformStamped(
        header=Header(stamp=TimeMsg(sec=sec, nanosec=nanosec), frame_id=parent),
        child_frame_id=child,
        transform=Transform(
            translation=Vector3(x=1.0, y=2.0, z=3.0),
            rotation=Quaternion(x=0.0, y=0.0, z=sin(angle), w=cos(angle)),
        ),
    )


def fastest_us(work: Callable[[], object], calls: int = 50, rounds: int = 500) -> float:
    """Return how long a call takes when nothing else runs, in microseconds."""
    best = float("inf")
    for _ in range(rounds):
        began = time.perf_counter_ns()
        for _ in range(calls):
            work()
        best = min(best, (time.perf_counter_ns() - began) / calls / 1000)
    return best


def lookups() -> None:
    """Compare a lookup over five interpolated edges with the arithmetic alone."""
    core = BufferCore()
    for step in range(1000):
        for edge in range(EDGES):
            core.set_transform(stamped(f"f{edge}", f"f{edge + 1}", SECOND + step * 10**7), "bench")
    asked = Time(nanoseconds=5 * SECOND + 3_000_000)
    tree = core._BufferCore__frames  # noqa: SLF001  # the arithmetic alone has no other name
    edges = walk(tree, "f0", f"f{EDGES}", asked.nanoseconds).up
    arithmetic_us = fastest_us(lambda: unit(chained(edges)))
    lookup_us = fastest_us(lambda: core.lookup_transform_core("f0", f"f{EDGES}", asked))
    can_us = fastest_us(lambda: core.can_transform_core("f0", f"f{EDGES}", asked))
    print(
        f"lookup over {EDGES} interpolated edges: {lookup_us:.1f} us, arithmetic alone "
        f"{arithmetic_us:.1f} us: {lookup_us / arithmetic_us:.2f} times; can_transform "
        f"{can_us:.1f} us"
    )


def insertions() -> None:
    """Show that an insertion takes as long with a long history as with a short one."""
    times = []
    for history in (100, 1_000, 10_000, 100_000):
        core = BufferCore(cache_time=history / 1000)
        msgs = [stamped("a", "b", SECOND + n * 10**6) for n in range(history + 2000)]
        for msg in msgs[:history]:
            core.set_transform(msg, "bench")
        rest = iter(msgs[history:])
        took = fastest_us(lambda: core.set_transform(next(rest), "bench"), 100, 20)  # noqa: B023
        times.append(f"{history}: {took:.2f} us")
    print("insertion by length of the history:", ", ".join(times))


def memory() -> None:
    """Show the memory taken by 100 frames of 100 Hz for 10 s."""
    core = BufferCore()
    tracemalloc.start()
    for step in range(1000):
        for frame in range(100):
            core.set_transform(stamped("map", f"f{frame}", SECOND + step * 10**7), "bench")
    size, _ = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    print(f"memory of 100 frames, 10 s, 100 Hz: {size / 1e6:.1f} MB, {size / 1e5:.0f} B each")


def batch(step: int) -> TFMessage:
    """Return a message of ten of the fifty frames."""
    first = step * PER_MESSAGE % FRAMES
    stamp_ns = SECOND + step * SECOND // RATE
    return TFMessage(
        transforms=[
            stamped("map", f"f{number}", stamp_ns) for number in range(first, first + PER_MESSAGE)
        ]
    )


async def share_of(
    node: Node, publish: Callable[[int], object], seconds: float, first: int = 0
) -> float:
    """Return the share of a processor used while messages are published at the rate."""
    clock = node.get_clock()
    cpu, began = time.process_time(), time.perf_counter()
    for step in range(first, first + round(seconds * RATE)):
        publish(step)
        late = began + (step - first + 1) / RATE - time.perf_counter()
        await clock.sleep(max(late, 0))
    return (time.process_time() - cpu) / (time.perf_counter() - began)


def publish(publisher: Publisher[TFMessage], made: list[TFMessage], step: int) -> None:
    """Publish one of the messages."""
    publisher.publish(made[step])


async def waiters(seconds: float) -> None:
    """Show the cost of a hundred pending waits with a thousand transforms per second."""
    made = [batch(step) for step in range(round(seconds * RATE))]
    shares = []
    for count, buffered in ((0, False), (0, True), (WAITERS, True)):
        async with Node("bench", context=Context(transport="local")) as node:
            publisher = node.create_publisher(TFMessage, "/tf", 100)
            if buffered:
                buffer = Buffer(node)
            else:
                node.create_subscription(TFMessage, "/tf", lambda _: None, 100)
            async with asyncio.TaskGroup() as group:
                tasks = [
                    group.create_task(
                        buffer.wait_for_transform("map", f"f{n % FRAMES}", Time(seconds=10**6 + n))
                    )
                    for n in range(count)
                ]
                shares.append(await share_of(node, partial(publish, publisher, made), seconds))
                for task in tasks:
                    task.cancel()
    plain, followed, awaited = (f"{share:.1%}" for share in shares)
    print(
        f"{RATE} messages a second of {PER_MESSAGE} transforms, {FRAMES} frames: publisher and "
        f"empty callback {plain}, with a buffer {followed}, and {WAITERS} waiters {awaited}; "
        f"buffer and waiters alone {shares[2] - shares[0]:.1%} of a processor"
    )


async def filters(seconds: float) -> None:
    """Show the cost of a thousand messages per second that wait in a filter."""
    shares = []
    for filtered in (False, True):
        async with Node("bench", context=Context(transport="local")) as node:
            buffer = Buffer(node)
            points = node.create_publisher(PointStamped, "point", 100)
            subscription = node.create_subscription(PointStamped, "point", None, 100)
            made = [
                PointStamped(header=stamped("f0", "", SECOND + step * SECOND // RATE).header)
                for step in range(round(seconds * RATE))
            ]

            async def read(filtered: bool = filtered) -> None:
                if not filtered:
                    async for _ in subscription:  # noqa: B023
                        pass
                async for _ in buffer.filter(subscription, "map"):  # noqa: B023
                    pass

            def publish_and_move(step: int) -> None:
                points.publish(made[step])  # noqa: B023
                # the transform arrives later than the message that waits for it
                if step % 20 == 19:
                    ends = SECOND + step * SECOND // RATE
                    buffer.set_transform(stamped("map", "f0", ends), "bench")  # noqa: B023

            async with asyncio.TaskGroup() as group:
                task = group.create_task(read())
                shares.append(await share_of(node, publish_and_move, seconds))
                task.cancel()
    print(
        f"{RATE} messages a second that wait some 10 ms: {shares[1]:.1%} in a filter, "
        f"{shares[0]:.1%} without; the filter alone {shares[1] - shares[0]:.1%} of a processor"
    )


def main() -> None:
    """Print all figures."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=3.0, help="for each figure at a rate")
    seconds = parser.parse_args().seconds
    lookups()
    insertions()
    memory()
    with suppress(KeyboardInterrupt):
        asyncio.run(waiters(seconds))
        asyncio.run(filters(seconds))


if __name__ == "__main__":
    main()
