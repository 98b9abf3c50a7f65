"""The processes of `peers.py`: one that measures, and one that answers, for one peer each."""

from __future__ import annotations

import json
import os
import statistics
import sys
import threading
import time
from collections.abc import Callable
from typing import Any, Final

from benchmarks.peer_parts.peers import PEERS, Peer

__all__ = ["BURST", "station"]

BURST: Final = 10_000
PERIOD_S: Final = 0.01
SILENCE_S: Final = 1.0  # after which the rest of a burst counts as lost
ASK, BEGIN, DROP, ANSWER, PIECE = (f"{letter:<23}" for letter in "abdep")  # 32 bytes of CDR


class Measuring:
    """The measuring end; each line of stdin is a question, answered in JSON."""

    def __init__(self, peer: Peer) -> None:
        self._peer = peer
        self._times: list[int] = []
        self._left = 0
        self._began_ns = 0
        self._arrived = 0
        self._first_ns = self._last_ns = 0
        self._send: Callable[[], object] = lambda: None
        peer.hear = self._hear

    def _hear(self, word: str) -> None:
        now_ns = time.perf_counter_ns()
        if word == PIECE:
            self._last_ns = now_ns
            if not self._arrived:
                self._first_ns = now_ns
            self._arrived += 1
            if self._arrived == BURST:
                self._peer.wake()
        elif self._left and word != DROP:
            self._times.append(now_ns - self._began_ns)
            self._left -= 1
            if self._left:
                self._throw()
            else:
                self._peer.wake()

    def _throw(self) -> None:
        self._began_ns = time.perf_counter_ns()
        self._send()

    def _go(self, count: int) -> None:
        self._left = count
        self._peer.soon(self._throw)
        self._peer.run(lambda: not self._left)

    def trips(self, count: int, pause_s: float, size: int) -> float:
        """Return the median of round trips in us: of a word, or of a block and an answer."""
        peer, block = self._peer, bytes([1]) * size
        self._send = (lambda: peer.say_block(block)) if size else (lambda: peer.say(ASK))
        self._times = []
        if not pause_s:
            self._go(count)
        else:
            for _ in range(count):
                peer.rest(pause_s)
                self._go(1)
        return statistics.median(self._times) / 1e3

    def burst(self) -> float:
        """Return a burst's rate of arrival, in messages per second; negative if some are lost."""
        self._arrived = 0
        peer = self._peer
        peer.soon(lambda: throw(peer) if peer.alone else peer.say(BEGIN))
        silent_s = 0.0
        while self._arrived < BURST and silent_s < SILENCE_S:
            before = self._arrived
            peer.rest(0.2)
            silent_s = 0.0 if self._arrived > before else silent_s + 0.2
        rate = (self._arrived - 1) / max(self._last_ns - self._first_ns, 1) * 1e9
        return rate if self._arrived == BURST else -rate

    def duty(self, seconds: float) -> int:
        """Send 100 words per second, which are dropped at the other end; return their number."""
        count = 0

        def say() -> None:
            nonlocal count
            count += 1
            self._peer.say(DROP)

        stop = self._peer.every(PERIOD_S, say)
        self._peer.rest(seconds)
        stop()
        return count

    def answer(self, line: str) -> Any:
        """Return the answer to one question."""
        what, *numbers = line.split()
        match what:
            case "trips":
                return self.trips(int(numbers[0]), float(numbers[1]), int(numbers[2]))
            case "burst":
                return self.burst()
            case "calls":
                return self._peer.calls_per_s(int(numbers[0]))
            case _:
                return self.duty(float(numbers[0]))


def throw(peer: Peer) -> None:
    """Send a burst."""
    for _ in range(BURST):
        peer.say(PIECE)


def say_ready(text: str = "ready") -> None:
    """Print one line of JSON."""
    print(json.dumps(text), flush=True)


def answering(peer: Peer) -> None:
    """Answer whatever arrives, until stdin is closed."""

    def hear(word: str) -> None:
        if word == BEGIN:
            throw(peer)
        elif word in (ASK, ""):
            peer.say(ANSWER)

    peer.hear = hear
    threading.Thread(target=lambda: (sys.stdin.read(), os._exit(0)), daemon=True).start()
    say_ready()
    peer.run(lambda: False)


def hearing(peer: Peer) -> None:
    """End with the first message."""

    def hear(_: str) -> None:
        say_ready("heard")
        os._exit(0)

    peer.hear = hear
    peer.open()
    peer.run(lambda: False)


def station(name: str, side: str, place: tuple[str, int], loop_name: str) -> None:
    """Run one end of a peer."""
    kind = PEERS[name]
    if side == "hear":
        hearing(kind("echo", place, loop_name))
    peer = kind(side, place, loop_name)
    try:
        peer.open()
    except ImportError as error:
        say_ready(f"skipped: {error}")
        return
    if side == "echo":
        answering(peer)
    measuring = Measuring(peer)
    say_ready()
    for line in sys.stdin:
        try:
            found = measuring.answer(line)
        except NotImplementedError:
            found = None
        print(json.dumps(found), flush=True)
    os._exit(0)
