"""Files that start programs which have no file of their own, or need aionode's rclpy."""

from __future__ import annotations

import hashlib
import os
import shlex
import shutil
import sys
import sysconfig
import tempfile
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Final

__all__ = ["is_starter_file", "starter_file", "tools_on_path"]

FOLDER: Final = "starters"


def starter_file(name: str, command: Sequence[str]) -> Path:
    """Return an executable file of a name that runs a command with the arguments it is given.

    It is in the user's cache (XDG_CACHE_HOME), in a folder with no other file.
    """
    text = f'#!/bin/sh\nexec {shlex.join(command)} "$@"\n'
    folder = hashlib.sha256(text.encode()).hexdigest()[:16]
    home = os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache"
    try:
        return written(Path(home, "aionode", FOLDER, folder, name), text)
    except OSError:  # no home, or it is read-only
        return written(Path(tempfile.mkdtemp(prefix="aionode_"), FOLDER, folder, name), text)


def written(file: Path, text: str) -> Path:
    """Write an executable file, unless it is there; another process may do so at the same time."""
    if not file.is_file() or file.read_text(encoding="utf-8") != text:
        file.parent.mkdir(parents=True, exist_ok=True)
        new = file.with_name(f".{file.name}-{os.getpid()}")
        new.write_text(text, encoding="utf-8")
        new.chmod(0o755)
        new.replace(file)
    return file


def is_starter_file(file: str) -> bool:
    """Return whether a file is one of these."""
    return Path(file).parent.parent.name == FOLDER


@contextmanager
def tools_on_path(starter: Callable[[Path], list[str]]) -> Iterator[None]:
    """Put the tools that launch files run by name on the PATH of this process, for a while.

    They are `xacro`, which is not there without an activated environment, and `ros2`, for which
    aionode's own command stands in. One that is on the PATH already, and is not that of this
    Python, stays the one that is found.

    Args:
        starter: Returns the command that starts a program.
    """
    xacro = shutil.which("xacro", path=sysconfig.get_path("scripts"))
    tools = {"ros2": [sys.executable, "-m", "aionode"]}
    if xacro is not None:
        tools["xacro"] = starter(Path(xacro))
    folders = [
        str(starter_file(name, command).parent)
        for name, command in tools.items()
        if shutil.which(name) in {None, shutil.which(name, path=sysconfig.get_path("scripts"))}
    ]
    before = os.environ.get("PATH")
    os.environ["PATH"] = os.pathsep.join(filter(None, [*folders, before]))
    try:
        yield
    finally:
        del os.environ["PATH"]
        if before is not None:
            os.environ["PATH"] = before
