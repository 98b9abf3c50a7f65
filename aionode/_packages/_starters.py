"""Files that start programs which have no file of their own, or need aionode's rclpy."""

from __future__ import annotations

import hashlib
import os
import shlex
import tempfile
from collections.abc import Sequence
from pathlib import Path

__all__ = ["starter_file"]


def starter_file(name: str, command: Sequence[str]) -> Path:
    """Return an executable file of a name that runs a command with the arguments it is given.

    It is in the user's cache (XDG_CACHE_HOME), in a folder with no other file.
    """
    text = f'#!/bin/sh\nexec {shlex.join(command)} "$@"\n'
    folder = hashlib.sha256(text.encode()).hexdigest()[:16]
    home = os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache"
    try:
        return written(Path(home, "aionode", "starters", folder, name), text)
    except OSError:  # no home, or it is read-only
        return written(Path(tempfile.mkdtemp(prefix="aionode_starter_"), name), text)


def written(file: Path, text: str) -> Path:
    """Write an executable file, unless it is there; another process may do so at the same time."""
    if not file.is_file() or file.read_text(encoding="utf-8") != text:
        file.parent.mkdir(parents=True, exist_ok=True)
        new = file.with_name(f".{file.name}-{os.getpid()}")
        new.write_text(text, encoding="utf-8")
        new.chmod(0o755)
        new.replace(file)
    return file
