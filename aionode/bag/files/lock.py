"""The lock on the folder of a bag, which keeps others from changing what is being recorded.

A writer holds it until its bag is closed. The kernel releases it when its process ends in any way;
a process that is merely stopped keeps it. So a bag that was not closed can be repaired at once if
nobody holds its lock, and not at all otherwise, however silent its topics are.
"""

from __future__ import annotations

import contextlib
import os
import re
import weakref
from pathlib import Path
from typing import TYPE_CHECKING, Final, Self

from aionode.errors import BagError

if TYPE_CHECKING:
    from types import TracebackType

with contextlib.suppress(ImportError):  # on Windows
    import fcntl

__all__ = ["FolderLock"]

LOCKS: Final = Path("/proc/locks")
"""The file in which Linux lists locks and their processes."""


class FolderLock:
    """An exclusive lock on a folder; ``with`` releases it.

    Forked children release it, as it would otherwise outlive the process that writes.

    Args:
        folder: The folder.

    Attributes:
        is_held: Whether it is held; False if the system has no such locks.

    Raises:
        BagError: another writer or repair holds it.
    """

    def __init__(self, folder: Path) -> None:
        self.is_held = False
        self._close: weakref.finalize[..., FolderLock] | None = None
        if not hasattr(os, "O_DIRECTORY"):  # on Windows
            return
        with contextlib.suppress(OSError):
            fd = os.open(folder, os.O_RDONLY | os.O_DIRECTORY | os.O_CLOEXEC)
            self._close = weakref.finalize(self, os.close, fd)
            self._close.atexit = False  # until the process has ended
            try:
                fcntl.flock(fd, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except BlockingIOError:
                self.release()
                raise BagError(
                    str(folder),
                    f"{holder_of(folder)} is recording or repairing it",
                    "wait until it has ended, or end it; nothing was changed",
                ) from None
            self.is_held = True
            LIVE.add(self)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self.release()

    def release(self) -> None:
        """Release it. Releasing again has no effect."""
        self.is_held = False
        if self._close is not None:
            self._close()


LIVE: Final[weakref.WeakSet[FolderLock]] = weakref.WeakSet()


def release_all() -> None:
    """Close the descriptors in a forked child; its parent keeps the locks."""
    for lock in list(LIVE):
        lock.release()


if hasattr(os, "register_at_fork"):  # not on Windows
    os.register_at_fork(after_in_child=release_all)


def holder_of(folder: Path) -> str:
    """Return who holds the lock of a folder, in words."""
    with contextlib.suppress(OSError):
        held = rf"FLOCK +ADVISORY +WRITE +(\d+) +\S+:{folder.stat().st_ino} "
        processes = set(re.findall(held, LOCKS.read_text()))
        if len(processes) == 1:
            return f"process {processes.pop()}"
    return "another process"
