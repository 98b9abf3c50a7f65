"""Limits of memory and processors for a process of a system, by cgroup v2 where allowed."""

from __future__ import annotations

import os
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from aionode.system._log import SystemLog

__all__ = ["Limits"]

PERIOD_US: Final = 100_000
"""Of ``cpu.max``: the kernel's own."""


@dataclass(frozen=True)
class Limits:
    """Limits of one process and all that it starts.

    Attributes:
        memory_bytes: How much memory they may have.
        cpu_cores: How many cores they may use, such as 0.5.
    """

    memory_bytes: int | None = None
    cpu_cores: float | None = None

    def settings(self) -> dict[str, str]:
        """Return what is written to which file of the cgroup."""
        files = {}
        if self.memory_bytes is not None:
            files["memory.max"] = str(self.memory_bytes)
        if self.cpu_cores is not None:
            files["cpu.max"] = f"{round(self.cpu_cores * PERIOD_US)} {PERIOD_US}"
        return files

    def enter(self, name: str, log: SystemLog) -> str | None:
        """Create a cgroup with these limits, and return its folder.

        Returns:
            None if there are no limits, or none are allowed here, which the log says.
        """
        settings = self.settings()
        if not settings:
            return None
        parent, folder = own_cgroup(), None
        try:
            if parent is None:
                raise FileNotFoundError("there is no cgroup v2 here")
            enable_controllers(parent, {file.partition(".")[0] for file in settings})
            folder = parent / f"aionode-{os.getpid()}-{name.strip('/').replace('/', '.')}"
            folder.mkdir(exist_ok=True)
            for file, value in settings.items():
                (folder / file).write_text(value)
        except OSError as error:
            log.note(
                f"{name}: runs without its limits ({', '.join(settings)}): {error}; give the "
                "service Delegate=yes and DelegateSubgroup=supervisor, or leave the limits to it"
            )
            if folder is not None:
                self.leave(str(folder))
            return None
        return str(folder)

    def leave(self, folder: str | None) -> None:
        """Remove the cgroup of a process that has ended."""
        if folder is not None:
            with suppress(OSError):  # the next start uses it again
                Path(folder).rmdir()


def enable_controllers(parent: Path, wanted: set[str]) -> None:
    """Let the cgroups below `parent` have limits of these kinds: ``cpu``, ``memory``.

    A cgroup that was delegated to this process has the controllers, and gives none to those below
    it before it is told to.

    Raises:
        OSError: there are no such controllers here, or it is not allowed.
    """
    if missing := wanted.difference((parent / "cgroup.controllers").read_text().split()):
        raise FileNotFoundError(f"cgroup v2 has no controller {', '.join(sorted(missing))} here")
    enabled = parent / "cgroup.subtree_control"
    if more := wanted.difference(enabled.read_text().split()):
        enabled.write_text(" ".join(f"+{controller}" for controller in more))


def own_cgroup(
    membership: Path = Path("/proc/self/cgroup"), root: Path = Path("/sys/fs/cgroup")
) -> Path | None:
    """Return the folder in which cgroups may be created, beside that of this process.

    A cgroup with processes has none below it that have limits, so it is the one above; only that
    at the root may have both.
    """
    try:
        lines = membership.read_text().splitlines()
    except OSError:
        return None
    mounts = (root, root / "unified")  # the second beside cgroups of version 1
    mount = next((mount for mount in mounts if (mount / "cgroup.controllers").exists()), None)
    own = next((line[3:].strip("/") for line in lines if line.startswith("0::")), None)
    if mount is None or own is None:
        return None
    return (mount / own).parent if own else mount
