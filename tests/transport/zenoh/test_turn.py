"""The turn to look for others: one process has it, and none waits for one that is frozen."""

from __future__ import annotations

import asyncio
import itertools
from collections.abc import Iterator
from contextlib import contextmanager
from types import SimpleNamespace
from typing import Any

import pytest

from aionode._concurrency import checkpoint
from aionode.transport.zenoh import _turn
from aionode.transport.zenoh._turn import MANY, Turn
from tests.support.peers import free_ports

pytestmark = pytest.mark.one_loop


@pytest.fixture
def port() -> int:
    """A free port, whose number is that of a meeting port."""
    return free_ports(1)[0]


@contextmanager
def taken(port: int) -> Iterator[Turn]:
    """The turn of another process, as long as it is not released."""
    turn = Turn()
    turn.take(port)
    try:
        yield turn
    finally:
        turn.release()


def session_with(*counts: int) -> Any:
    """A session with so many connections when it is asked for the first time, the second, …."""
    left = itertools.chain(counts, itertools.repeat(counts[-1]))
    return SimpleNamespace(info=SimpleNamespace(transports=lambda: [None] * next(left)))


async def test_the_next_one_has_the_turn_when_it_is_released(port: int) -> None:
    """Whoever waits polls, and gets it."""
    waiting = Turn()
    with taken(port) as turn:
        async with asyncio.TaskGroup() as tasks:
            tasks.create_task(asyncio.to_thread(waiting.take, port))
            turn.release()

        assert waiting._socket is not None
        waiting.release()


def test_the_turn_of_a_frozen_process_is_not_waited_for(
    port: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The others go on without it, as they would find each other a little later anyhow."""
    monkeypatch.setattr(_turn, "TURN_S", 0.01)
    other = Turn()
    with taken(port):
        other.take(port)

        assert other._socket is None


def test_as_long_as_the_turn_changes_hands_it_is_waited_for(
    port: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The hundredth process waits for 99, each of which is quick."""
    seconds = itertools.count(0, int(_turn.TURN_S * 2e9))
    monkeypatch.setattr(_turn, "perf_ns", lambda: next(seconds))  # each look is too late
    monkeypatch.setattr(_turn, "POLL_S", 0.0)
    other = Turn()
    with taken(port) as turn:
        others = iter(["1", "2", "3"])

        def next_holder(_: int) -> str:
            holder = next(others, "")
            if not holder:
                turn.release()
            return holder

        monkeypatch.setattr(_turn, "holder_of", next_holder)
        other.take(port)

        assert other._socket is not None
        other.release()


def test_the_socket_of_the_holder_is_found_in_the_list_of_the_system(port: int) -> None:
    """That tells one holder from the next."""
    with taken(port):
        first = _turn.holder_of(port)
    with taken(port):
        second = _turn.holder_of(port)

    assert first != second or not first  # elsewhere than on Linux there is no such list
    assert not _turn.holder_of(port)


async def test_a_process_with_few_peers_gives_the_turn_up_at_once(port: int) -> None:
    """They are connected within milliseconds."""
    with taken(port) as turn:
        turn.release_when_connected(session_with(MANY - 1))

        assert turn._socket is None


async def test_a_process_with_many_peers_keeps_the_turn_until_no_more_are_connected(
    port: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Else all would connect with all at once, and none would get far."""
    monkeypatch.setattr(_turn, "QUIET_S", 0.0)
    with taken(port) as turn:
        turn.release_when_connected(session_with(MANY, MANY + 9, MANY + 9))
        kept = turn._socket is not None
        while turn._socket is not None:
            await checkpoint()

        assert kept


async def test_a_process_whose_peers_come_and_go_gives_the_turn_up_in_time(
    port: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The others wait for it."""
    monkeypatch.setattr(_turn, "QUIET_S", 0.0)
    seconds = itertools.count(0, int(1e9))
    monkeypatch.setattr(_turn, "perf_ns", lambda: next(seconds))
    with taken(port) as turn:
        turn.release_when_connected(session_with(*range(MANY, MANY + 100)))
        while turn._socket is not None:
            await checkpoint()

        assert next(seconds) < 10e9
