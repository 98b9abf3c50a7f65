"""The work of one client: bounded in memory, whatever its ops are."""

from __future__ import annotations

import asyncio
from functools import partial

import pytest

from aionode._process.concurrency import checkpoint
from aionode.errors import MessageError
from aionode.gateway.session import lanes as lanes_module
from aionode.gateway.session.lanes import MAX_WEIGHT, Lanes, weight_of

HALF = "x" * (MAX_WEIGHT // 2)
POSES = '{"poses":[' + ",".join(["{}"] * 99_000) + "]}"
"""A frame of 297 kB whose values take 7 MB."""


def test_objects_weigh_more_than_their_text() -> None:
    """An empty one has two characters, and takes 64 bytes."""
    assert weight_of(POSES) > 6_000_000
    assert weight_of(POSES.encode()) == weight_of(POSES)


async def test_a_frame_waits_for_room() -> None:
    """Its client is not read meanwhile, so nothing is lost; completed ops make room."""
    may_end = asyncio.Event()
    done: list[int] = []

    async def work(number: int) -> None:
        await may_end.wait()
        done.append(number)

    async with asyncio.TaskGroup() as tasks:
        lanes = Lanes(tasks)
        for number in (1, 2):
            await lanes.admit(HALF)
            await lanes.put("publish", partial(work, number))
        third = tasks.create_task(lanes.admit(HALF))
        await checkpoint()
        assert not third.done()
        may_end.set()
        await third

    assert done[0] == 1


async def test_a_frame_without_room_is_refused_after_a_while(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A call may wait for a frame of the same client, which therefore has to be read."""
    monkeypatch.setattr(lanes_module, "PATIENCE_SEC", 0.0)

    async def wait() -> None:
        await asyncio.Event().wait()

    async with asyncio.TaskGroup() as tasks:
        lanes = Lanes(tasks)
        await lanes.admit(HALF)
        call = lanes.start(wait)
        await lanes.admit("{}")
        with pytest.raises(MessageError, match="wait for them, or send smaller"):
            await lanes.admit(HALF * 2)
        call.cancel()
        await asyncio.wait([call])
        await lanes.admit(HALF * 3)  # alone, any frame may pass
