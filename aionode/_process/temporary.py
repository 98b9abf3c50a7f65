"""Temporary folders that are removed with this process, even if it ends without exit handlers."""

from __future__ import annotations

import atexit
import os

__all__ = ["remove_temporary_folders", "temporary_folder"]

_folders: list[tuple[int, str]] = []
"""The process that removes a folder, since forks of it must not, and the folder."""


def temporary_folder(prefix: str) -> str:
    """Create a folder that is removed with this process, and return its path.

    Args:
        prefix: The prefix of its name.
    """
    import tempfile  # imports archive modules, which few programs need

    if not _folders:
        atexit.register(remove_temporary_folders)
    folder = tempfile.mkdtemp(prefix=prefix)
    _folders.append((os.getpid(), folder))
    return folder


def remove_temporary_folders() -> None:
    """Remove the folders; call this before ending the process by `os._exit`."""
    while _folders:
        process, folder = _folders.pop()
        if process == os.getpid():
            import shutil  # as above

            shutil.rmtree(folder, ignore_errors=True)
