"""Restarts members of a system when their programs' files change."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import suppress
from pathlib import Path
from stat import S_ISREG
from typing import TYPE_CHECKING, Any

from aionode.clock import SteadyClock

if TYPE_CHECKING:
    from aionode.system import System

__all__ = ["restart_changed"]

EVERY_SEC = 0.5


async def restart_changed(system: System) -> None:
    """Restart each process when a file in its command line changes; never return.

    A process that has ended is started again too, as a file may have been saved half written.
    """
    clock = SteadyClock()
    seen: dict[str, dict[Path, int]] = {}
    while True:
        for name in system.status():
            times = dict(times_of(command_line(system.member(name))))
            before = seen.setdefault(name, times)
            if times != before:
                seen[name] = times
                system.log.note(f"{name} is restarted: its program has changed")
                await system.restart(name)
        await clock.sleep(EVERY_SEC)


def command_line(member: Any) -> Iterable[str]:
    """Return the command line of a member; empty if it has no process of its own."""
    process = getattr(member, "process", None)
    return () if process is None else process.argv


def times_of(words: Iterable[str]) -> Iterator[tuple[Path, int]]:
    """Yield the files named in words, with their modification times in nanoseconds.

    They are programs, their parameters, and files of node classes.
    """
    for word in words:
        file = Path(word.partition(".py:")[0] + ".py") if ".py:" in word else Path(word)
        with suppress(OSError, ValueError):  # missing at the moment, or not a path
            status = file.stat()
            if file.suffix and S_ISREG(status.st_mode):
                yield file, status.st_mtime_ns
