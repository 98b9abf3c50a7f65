"""Waits for what happens in a thread or process that sets no event."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

__all__ = ["until", "waited_s"]

PERIOD_S = 0.002


async def until(condition: Callable[[], Any]) -> None:
    """Wait until a condition holds, without using the processor."""
    while not condition():  # noqa: ASYNC110  # there is no event
        await asyncio.sleep(PERIOD_S)  # noqa: TID251  # as above


def waited_s() -> float:
    """Return how long the threads of this process were ready without a processor, in seconds.

    Beside other work that is most of what anything takes. It is 0 where the system does not say.
    """
    total_ns = 0
    for path in Path("/proc/self/task").glob("*/schedstat"):
        with suppress(OSError):  # the thread has just ended
            total_ns += int(path.read_text().split()[1])
    return total_ns / 1e9
