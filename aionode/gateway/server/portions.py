"""Passes the received bytes of a connection to its parser in parts."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from typing import Final

__all__ = ["Portions"]

PART: Final = 1024
"""Bytes that a parser gets at a time: some 170 frames or chunks of one byte."""

TURN_SEC: Final = 0.002
"""How long parts are passed on before timers, I/O and callbacks of the robot run, in seconds."""


class Portions:
    """Passes on what a connection has received, in parts, yielding to the event loop between them.

    One read returns up to 256 kB. Given all of it at once, a parser takes a second if it consists
    of tiny frames or chunks, and would block the robot's event loop.

    Args:
        transport: Its reading is paused while something waits.
        take: Processes a part.
        is_ready: Returns whether `take` can be called now; by default it always can. After it
            returned False, `go_on` has to be called as soon as it can.

    Attributes:
        owed_sec: How long nothing more is passed on, in seconds; set by `take`.
    """

    def __init__(
        self,
        transport: asyncio.Transport,
        take: Callable[[bytes], None],
        is_ready: Callable[[], bool] = lambda: True,
    ) -> None:
        self._transport = transport
        self._take = take
        self._is_ready = is_ready
        self._loop = asyncio.get_running_loop()
        self._waiting = bytearray()
        self._turn: asyncio.Handle | None = None
        self._is_closed = False
        self.owed_sec = 0.0

    def __bool__(self) -> bool:
        """Return whether something waits."""
        return bool(self._waiting)

    def add(self, data: bytes) -> None:
        """Add received data."""
        if not self._waiting and self._turn is None and len(data) <= PART and self._is_ready():
            self._take(data)
            self._wait_if_owed()
        else:
            self._waiting += data
            if self._turn is None:
                self._hand_on()

    def go_on(self) -> None:
        """Pass on what waits, from the next loop iteration on."""
        if self._turn is None and not self._is_closed:
            self._turn = self._loop.call_soon(self._next_turn)

    def close(self) -> bytes:
        """Stop passing anything on, and return what waits."""
        self._is_closed = True
        waiting = bytes(self._waiting)
        self._waiting.clear()
        if self._turn is not None:
            self._turn.cancel()
        return waiting

    def _next_turn(self) -> None:
        self._turn = None
        self._hand_on()

    def _hand_on(self) -> None:
        until_s = self._loop.time() + TURN_SEC
        while self._waiting and self._is_ready():
            if self._transport.is_closing():  # nobody reads what a parser would return for the rest
                self._waiting.clear()
                return
            part = bytes(self._waiting[:PART])
            del self._waiting[:PART]
            self._take(part)
            if self._wait_if_owed():
                return
            if self._waiting and self._loop.time() > until_s:
                self.go_on()
                break
        if self._waiting:
            self._transport.pause_reading()
        elif not self._is_closed and self._is_ready():
            self._transport.resume_reading()

    def _wait_if_owed(self) -> bool:
        """Pass on nothing more for the time that is owed, and return whether any is."""
        if not self.owed_sec or self._is_closed:
            return False
        self._transport.pause_reading()
        self._turn = self._loop.call_later(self.owed_sec, self._next_turn)
        self.owed_sec = 0.0
        return True
