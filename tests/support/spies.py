"""Lets a test wait for calls within aionode, where no public call waits for a state."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import pytest

__all__ = ["returns_of"]


def returns_of(monkeypatch: pytest.MonkeyPatch, owner: object, name: str) -> asyncio.Queue[Any]:
    """Return a queue that gets the results of a method of `owner` from now on."""
    returned = asyncio.Queue[Any]()
    method = getattr(owner, name)

    def call(*args: Any) -> Any:
        result = method(*args)
        returned.put_nowait(result)
        return result

    monkeypatch.setattr(owner, name, call)
    return returned
