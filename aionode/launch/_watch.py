"""Restarts members of a system when the files of their programs change."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING

from aionode.clock import SteadyClock

if TYPE_CHECKING:
    from aionode.system import System

__all__ = ["restart_changed"]

EVERY_SEC = 0.5


async def restart_changed(system: System) -> None:
    """Restart each process when a file of its command line has changed; never return."""
    clock = SteadyClock()
    seen: dict[str, dict[Path, int]] = {}
    while True:
        for name, files in files_of(system):
            times = {file: time for file in files if (time := changed_ns(file)) is not None}
            before = seen.setdefault(name, times)
            if times != before:
                seen[name] = times
                system.log.note(f"{name} is restarted: its program has changed")
                await system.restart(name)
        await clock.sleep(EVERY_SEC)


def files_of(system: System) -> list[tuple[str, list[Path]]]:
    """Return the files on the command line of each process that runs."""
    found = []
    for name, status in system.status().items():
        if status.pid is not None:
            found.append((name, list(program_files(command_line(status.pid)))))
    return found


def command_line(pid: int) -> list[str]:
    """Return the words of the command line of a process; none if it has ended."""
    try:
        return Path(f"/proc/{pid}/cmdline").read_text(encoding="utf-8").split("\0")
    except (OSError, ValueError):
        return []


def program_files(words: Iterable[str]) -> Iterable[Path]:
    """Yield the files that words name: programs, their parameters, and files of node classes."""
    for word in words:
        file = Path(word.partition(".py:")[0] + ".py") if ".py:" in word else Path(word)
        if file.suffix and file.is_file():
            yield file


def changed_ns(file: Path) -> int | None:
    """Return when a file was changed last, in nanoseconds; None if it is not there."""
    try:
        return file.stat().st_mtime_ns
    except OSError:
        return None
