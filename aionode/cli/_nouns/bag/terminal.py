"""Keys and a progress line while a bag is recorded or played in a terminal."""

from __future__ import annotations

import asyncio
import contextlib
import os
import sys
from typing import TYPE_CHECKING, Any, Final

from aionode.clock import Clock, ClockType

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping

__all__ = ["DOWN", "RIGHT", "SPACE", "UP", "keys_pressed", "progress_shown"]

SPACE: Final = " "
UP: Final = "\x1b[A"
DOWN: Final = "\x1b[B"
RIGHT: Final = "\x1b[C"
CLEAR_LINE: Final = "\r\x1b[K"
MAX_BYTES: Final = 64
"""Maximum bytes to read at once; a key has at most three."""


@contextlib.contextmanager
def keys_pressed(actions: Mapping[str, Callable[[], object]], *, wanted: bool) -> Iterator[None]:
    """Call the action of each key that is pressed, inside the block.

    Does nothing without a terminal, or in the background of a shell.
    """
    if not (wanted and has_keys()):
        yield
        return
    import termios
    import tty

    fd = sys.stdin.fileno()

    def read() -> None:
        typed = os.read(fd, MAX_BYTES).decode(errors="replace")
        while typed:
            key = next((action for action in actions if typed.startswith(action)), typed[0])
            typed = typed[len(key) :]
            actions.get(key, ignore)()

    before: list[Any] = termios.tcgetattr(fd)
    tty.setcbreak(fd)  # one key at a time; Ctrl-C still raises a signal
    loop = asyncio.get_running_loop()
    loop.add_reader(fd, read)
    try:
        yield
    finally:
        loop.remove_reader(fd)
        termios.tcsetattr(fd, termios.TCSADRAIN, before)


def has_keys() -> bool:
    """Return whether this process may read keys: a background process would be stopped."""
    try:
        return sys.stdin.isatty() and os.tcgetpgrp(sys.stdin.fileno()) == os.getpgrp()
    except (AttributeError, OSError, ValueError):
        return False


def ignore() -> None:
    """Do nothing, for keys that have no meaning."""


@contextlib.asynccontextmanager
async def progress_shown(text: Callable[[], str], rate_hz: float) -> Any:
    """Show a progress line inside the block at `rate_hz`, if stderr is a terminal."""
    if rate_hz <= 0 or not sys.stderr.isatty():
        yield
        return
    clock = Clock(clock_type=ClockType.STEADY_TIME)

    async def show() -> None:
        while True:
            sys.stderr.write(f"{CLEAR_LINE}{text()}")
            sys.stderr.flush()
            await clock.sleep(1 / rate_hz)

    async with asyncio.TaskGroup() as tasks:
        showing = tasks.create_task(show())
        try:
            yield
        finally:
            showing.cancel()
            sys.stderr.write(f"{CLEAR_LINE}{text()}\n")
            sys.stderr.flush()
