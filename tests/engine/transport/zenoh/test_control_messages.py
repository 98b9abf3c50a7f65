"""Subscribers for control messages: one for each key with a listener in this context."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Hashable
from types import SimpleNamespace
from typing import Any

import pytest

from aionode.engine.transport.loop_waker import LoopWaker
from aionode.engine.transport.zenoh.delivery.control_messages import ControlSubscribers
from tests.support.waiting import until


class Session:
    """A session that records what is declared in it.

    Attributes:
        callbacks: The callbacks for samples, by key.
        declared: The number of declared subscribers.
    """

    def __init__(self) -> None:
        self.callbacks: dict[str, Any] = {}
        self.declared = 0

    def declare_subscriber(self, key: str, handler: Any, **_: Any) -> Any:
        """Declare a subscriber."""
        assert key not in self.callbacks
        self.declared += 1
        self.callbacks[key] = handler.callback
        return SimpleNamespace(undeclare=lambda: self.callbacks.pop(key))


Heard = list[tuple[str, dict[Hashable, str]]]


@pytest.fixture
async def heard() -> Heard:
    """The key of each message, and the listeners that it is for."""
    return []


@pytest.fixture
async def subscribers(heard: Heard) -> AsyncIterator[ControlSubscribers[str]]:
    """Subscribers whose listeners are words."""
    waker = LoopWaker()
    waker.open(asyncio.get_running_loop())

    def handle(sample: Any, listeners: dict[Hashable, str]) -> None:
        heard.append((sample.key_expr, dict(listeners)))

    yield ControlSubscribers(waker, handle, limit=10)
    waker.close()


async def test_a_key_has_one_subscriber_that_goes_with_its_last_listener(
    subscribers: ControlSubscribers[str],
) -> None:
    """Each is announced to every other process."""
    session: Any = Session()
    subscribers.start(session)
    for name in (1, 2, 2):
        subscribers.listen("a", name, f"listener {name}")
    subscribers.listen("b", 1, "another")
    assert session.callbacks.keys() == {"a", "b"}

    subscribers.unlisten("a", 1)
    assert session.callbacks.keys() == {"a", "b"}
    subscribers.unlisten("a", 2)
    subscribers.unlisten("a", 2)
    assert session.callbacks.keys() == {"b"}
    assert session.declared == 2


async def test_listeners_hear_in_the_next_session_too(subscribers: ControlSubscribers[str]) -> None:
    """A session is closed and opened again while endpoints live."""
    subscribers.listen("a", 1, "early")
    for session in (Session(), Session()):
        opened: Any = session
        subscribers.start(opened)
        assert session.callbacks.keys() == {"a"}
        subscribers.stop()
        assert not session.callbacks


async def test_a_message_is_for_the_listeners_of_its_key(
    subscribers: ControlSubscribers[str], heard: Heard
) -> None:
    """One that arrives after the last listener has gone is for nobody."""
    session: Any = Session()
    subscribers.start(session)
    subscribers.listen("a", 1, "gone soon")
    subscribers.listen("b", 1, "stays")
    session.callbacks["a"](SimpleNamespace(key_expr="a"))
    session.callbacks["b"](SimpleNamespace(key_expr="b"))
    subscribers.unlisten("a", 1)
    await until(lambda: heard)

    assert heard == [("b", {1: "stays"})]
