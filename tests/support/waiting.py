"""Waits for what happens in a thread or process that sets no event."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import Any

__all__ = ["until"]

PERIOD_S = 0.002


async def until(condition: Callable[[], Any]) -> None:
    """Wait until a condition holds, without using the processor."""
    while not condition():  # noqa: ASYNC110  # there is no event
        await asyncio.sleep(PERIOD_S)  # noqa: TID251  # as above
