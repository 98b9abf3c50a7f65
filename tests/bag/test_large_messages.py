"""Large messages of other processes: a recorder reads them where their sender has put them."""

from __future__ import annotations

import tracemalloc
from contextlib import asynccontextmanager
from typing import TYPE_CHECKING, Any

import pytest

from aionode import bag
from aionode.engine.wire import cdr
from aionode.interfaces.sensor_msgs.msg import Image
from tests.support.links import Counting, folder, link_of, two_nodes, writer_of
from tests.support.waiting import until

if TYPE_CHECKING:
    from collections.abc import AsyncIterator
    from pathlib import Path

    from aionode.engine.transport.link._connection import Connection

__all__ = ["folder"]  # a fixture

SIZE = 6_000_000
IMAGE = Image(height=1, width=SIZE, step=SIZE, data=bytes(range(250)) * (SIZE // 250))


@asynccontextmanager
async def recorded_over_a_link(path: Path, **options: Any) -> AsyncIterator[tuple[Any, Connection]]:
    """Record the images of another context; provides their publisher, and its link."""
    async with two_nodes() as nodes:
        numbers = Counting(nodes)
        await numbers.until_linked()
        publisher = nodes.a.create_publisher(Image, "images", 10)
        async with bag.Recorder(
            path, topics=["/images"], context=nodes.b.context, compression="none", **options
        ):
            await numbers.go_until(lambda: writer_of(publisher).linked)
            yield publisher, link_of(nodes.a)


def recorded(path: Path) -> list[bytes]:
    """Return the messages in a bag."""
    with bag.open(path) as run:
        return [record.raw for record in run.read("/images")]


async def test_a_recorder_does_not_copy_an_image_that_comes_over_a_link(tmp_path: Path) -> None:
    """The loop would be busy for milliseconds: its thread writes from the shared memory."""
    async with recorded_over_a_link(tmp_path / "run") as (publisher, link):
        publisher.publish(IMAGE)  # # what comes with the first one stays
        await until(lambda: not link.lent)
        tracemalloc.start()
        try:
            before, _ = tracemalloc.get_traced_memory()
            publisher.publish(IMAGE)
            assert link.lent
            await until(lambda: not link.lent)
            _, peak = tracemalloc.get_traced_memory()
        finally:
            tracemalloc.stop()
    assert peak - before < SIZE // 2
    assert recorded(tmp_path / "run") == [cdr.encode(IMAGE)] * 2


async def test_a_snapshot_keeps_no_memory_of_a_publisher(tmp_path: Path) -> None:
    """It may last for hours, and a process lends only so much."""
    options = {"snapshot": True}
    async with recorded_over_a_link(tmp_path / "run", **options) as (publisher, link):
        publisher.publish(IMAGE)
        await until(lambda: not link.lent)


async def test_a_recorder_that_falls_behind_keeps_no_memory_of_a_publisher(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What a slow disk leaves waiting is copied, beyond a few messages."""
    monkeypatch.setattr("aionode.bag.recording.writer_thread.BATCH_S", 60)
    monkeypatch.setattr("aionode.bag.recording.recording.MAX_LENT", SIZE)
    async with recorded_over_a_link(tmp_path / "run") as (publisher, link):
        for _ in range(5):
            publisher.publish(IMAGE)
            await until(lambda: len(link.lent) == 1)  # # only the first, which waits for the disk
    assert recorded(tmp_path / "run") == [cdr.encode(IMAGE)] * 5
