"""The thread in which a context of rclpy communicates."""

from __future__ import annotations

import asyncio
import threading
from typing import Self

import pytest

from aionode import Context
from rclpy._impl.io_thread import IoThread


@pytest.mark.timeout(30)
def test_a_thread_that_is_still_opening_can_be_stopped() -> None:
    """Ctrl-C may interrupt `rclpy.init` there, and the thread is then closed at once."""
    opening, may_open = threading.Event(), threading.Event()

    class SlowContext(Context):
        async def __aenter__(self) -> Self:
            opening.set()
            await asyncio.to_thread(may_open.wait)
            return await super().__aenter__()

    io = IoThread(SlowContext())
    starter = threading.Thread(target=io.start)
    starter.start()
    opening.wait()
    did: list[str] = []
    io.post(lambda: did.append("posted"))
    threading.Timer(0.05, may_open.set).start()
    io.stop()
    starter.join()

    assert did == ["posted"]
    assert not [each for each in threading.enumerate() if each.name == "rclpy-io"]
