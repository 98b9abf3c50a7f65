"""Signal handlers and finalizers use objects that the interrupted thread is just using.

`interruptions.py` has the programs. In rclpy a call is a single C call, which nothing interrupts;
here nothing may hang, be lost, or leave a context that no longer receives.
"""

from __future__ import annotations

import json
import os
import signal
import sys
from pathlib import Path
from typing import Any

import pytest

from rclpy._impl import uninterrupted
from tests.support import fork_server
from tests.support.peers import isolated_environment

PROGRAM = Path(__file__).parent / "interruptions.py"
PATIENCE_S = 60.0
"""Longest time for a program, in seconds; it takes two."""

WELL = dict.fromkeys(("publish", "spin", "ask"), "well at 10 places")

pytestmark = [
    pytest.mark.timeout(90),
    pytest.mark.skipif(sys.platform == "win32", reason="signals are POSIX's"),
]


def run(name: str) -> dict[str, Any]:
    """Return the output of a program. Its lines are not counted: that takes minutes."""
    counting = {name: "" for name in os.environ if name.startswith("COVERAGE_PROCESS")}
    process = fork_server.run(
        ["-m", "aionode.rclpy", str(PROGRAM), name],
        timeout=PATIENCE_S,
        env={**os.environ, **counting, **isolated_environment()},
    )
    assert process.stdout, process.stderr
    said: dict[str, Any] = json.loads(process.stdout)
    return said


@pytest.mark.slow
def test_a_handler_publishes_while_the_main_thread_publishes() -> None:
    """The last command of a program that is to end: all of them are numbered and sent."""
    assert run("publishes") == {"handled": True, "stops": True, "commands": 10_000}


def test_a_handler_asks_while_the_main_thread_publishes_or_spins() -> None:
    """The answer arrives over a link, which some thread has to read."""
    assert run("asks") == {"answers": True}


def test_a_handler_that_interrupts_the_look_at_handlers_may_wait(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The main thread checks whether it may do work; its work has not begun yet."""

    def interrupted_look() -> bool:
        uninterrupted.refuse_to_wait()
        return False

    monkeypatch.setattr(uninterrupted.Handlers, "harmless", None)
    monkeypatch.setattr(uninterrupted, "handlers_are_harmless", interrupted_look)

    assert not uninterrupted.begin()


def test_a_handler_creates_and_destroys_entities_while_the_main_thread_does() -> None:
    """In the end there is only what the program had before, with the topic of its parameters."""
    assert run("makes_entities") == {"left": [3, 1]}


def test_a_handler_raises_at_any_place() -> None:
    """It is like a handler that ends a program: messages sent after it are received."""
    assert run("raises") == WELL


def test_a_handler_that_puts_itself_off_raises_at_any_place() -> None:
    """It is like rclpy's own: with it, the main thread sends and reads itself."""
    assert run("puts_itself_off") == WELL


@pytest.mark.slow
@pytest.mark.parametrize("does", ["publishes", "asks"])
def test_a_finalizer_communicates_at_any_place(does: str) -> None:
    """The garbage collector calls it anywhere; where it cannot wait, it gets an error."""
    assert run(f"finalizer_{does}") == WELL


def test_a_handler_that_is_installed_later_is_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    """Nothing looks at the handlers before each message: a change of one is noted."""
    ours = {each for each in map(signal.getsignal, signal.valid_signals()) if callable(each)}
    monkeypatch.setattr(uninterrupted, "own_handlers", ours)
    monkeypatch.setattr(uninterrupted.Handlers, "harmless", None)
    assert uninterrupted.begin()
    uninterrupted.end()

    before = signal.signal(signal.SIGUSR1, lambda *_: None)
    try:
        assert not uninterrupted.begin()
    finally:
        signal.signal(signal.SIGUSR1, before)
