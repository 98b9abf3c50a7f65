"""Silence over every transport."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING

from aionode.interfaces.std_msgs.msg import Int32

if TYPE_CHECKING:
    from tests.endpoints.qos.conftest import Pair


class Driven:
    """The commands that have reached the wheels: their numbers, and ``stop``."""

    def __init__(self, pair: Pair, silence_sec: float) -> None:
        self.log: list[object] = []
        self._changed = asyncio.Event()
        self.subscription = pair.listener.create_subscription(
            Int32,
            "n",
            lambda msg: self._note(msg.data),
            on_silence=lambda: self._note("stop"),
            silence_sec=silence_sec,
        )

    def _note(self, item: object) -> None:
        self.log.append(item)
        self._changed.set()

    async def are(self, *items: object) -> None:
        """Wait until these have come, and expect no others."""
        while len(self.log) < len(items):
            self._changed.clear()
            await self._changed.wait()
        assert self.log == list(items)


async def test_a_topic_falls_silent(pair: Pair) -> None:
    """The topic then resumes."""
    driven = Driven(pair, 0.3)
    publisher = pair.talker.create_publisher(Int32, "n", 10)
    await pair.know_each_other(publisher, driven.subscription)
    publisher.publish(Int32(data=1))
    await driven.are(1)
    await pair.clock.advance(0.299)
    await driven.are(1)
    await pair.clock.advance(0.001)
    await driven.are(1, "stop")
    await pair.clock.advance(0.001)
    publisher.publish(Int32(data=2))
    await driven.are(1, "stop", 2)


async def test_the_last_publisher_is_destroyed(pair: Pair) -> None:
    """Its end ends all commands at once; no time passes here."""
    driven = Driven(pair, 60)
    publisher = pair.talker.create_publisher(Int32, "n", 10)
    await pair.know_each_other(publisher, driven.subscription)
    publisher.publish(Int32(data=1))
    await driven.are(1)
    publisher.destroy()
    await driven.are(1, "stop")
