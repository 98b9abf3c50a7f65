"""What is shipped to a robot: the files of a workspace, its wheels, and a systemd unit."""

from __future__ import annotations

import configparser
import hashlib
import os
import shlex
import subprocess
import sys
import tarfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from typing import Final

import click

from aionode._packages import Packages

__all__ = ["Release", "release_of"]

LEFT_OUT: Final = frozenset({"build", "install", "log", "node_modules", "__pycache__"})
"""Folders with files that were generated from others."""

BUILDS_A_WHEEL: Final = ("pyproject.toml", "setup.py")
CURRENT: Final = "current"


@dataclass(frozen=True)
class Release:
    """Everything that one deployment ships.

    Attributes:
        workspace: The folder that it comes from.
        unit: The file of the unit, in that folder.
        folder: The folder on the robot.
        user: The user that runs it there.
        files: The files of the workspace, relative to it.
        packages: The packages from which wheels are built.
        wheels: Wheels that are shipped unchanged.
    """

    workspace: Path
    unit: Path
    folder: PurePosixPath
    user: str
    files: tuple[Path, ...]
    packages: tuple[Path, ...]
    wheels: tuple[Path, ...]

    @property
    def id(self) -> str:
        """A name that stays the same until something that is shipped changes."""
        digest = hashlib.sha256()
        for file in (*(self.workspace / file for file in self.files), *self.wheels):
            name = file.relative_to(self.workspace) if file not in self.wheels else file.name
            mode = "x" if os.access(file, os.X_OK) else "-"
            content = file.read_bytes()
            digest.update(f"{name}\0{mode}\0{len(content)}\0".encode(errors="surrogateescape"))
            digest.update(content)
        return digest.hexdigest()[:12]

    def write(self, archive: Path, wheels: Path) -> None:
        """Build the wheels into a folder, and write the archive that is shipped.

        Raises:
            click.ClickException: A wheel cannot be built.
        """
        for package in self.packages:
            pip = [sys.executable, "-m", "pip", "--disable-pip-version-check", "wheel", "--quiet"]
            done = subprocess.run(  # noqa: S603  # pip, with a folder that the user names
                [*pip, "--no-deps", "--wheel-dir", str(wheels), str(package)], check=False
            )
            if done.returncode:
                raise click.ClickException(
                    f"{package}: pip could not build a wheel of it; "
                    f"`{shlex.join([*pip, '--no-deps', str(package)])}` does the same"
                )
        with tarfile.open(archive, "w") as tar:
            for file in self.files:
                tar.add(self.workspace / file, file, filter=without_owner)
            for wheel in (*sorted(wheels.glob("*.whl")), *self.wheels):
                tar.add(wheel, f"wheels/{wheel.name}", filter=without_owner)


def without_owner(entry: tarfile.TarInfo) -> tarfile.TarInfo:
    """Return the entry of an archive without its owner, who is known only on this host."""
    entry.uid = entry.gid = 0
    entry.uname = entry.gname = ""
    return entry


def release_of(workspace: Path, unit: Path | None, wheels: tuple[Path, ...]) -> Release:
    """Return what a workspace ships.

    Args:
        workspace: The folder of the packages.
        unit: The file of the unit; by default the only one in that folder.
        wheels: Additional wheels to ship.

    Raises:
        click.UsageError: There is no such unit, or it does not name its folder; there is nothing
            to install.
    """
    workspace = workspace.resolve()
    unit = (unit or only_unit(workspace)).resolve()
    if unit.parent != workspace:
        raise click.UsageError(f"{unit}: is not in {workspace}; put the unit there")
    folder, user = place_in(unit)
    packages = tuple(
        place
        for _, place in sorted(Packages(workspace).sources().items())
        if any((place / name).is_file() for name in BUILDS_A_WHEEL)
    )
    if not packages and not wheels:
        raise click.UsageError(
            f"{workspace}: no package in it has a pyproject.toml or a setup.py, so there is "
            "nothing to install; give a folder such as `aionode new` writes, or --wheel FILE"
        )
    return Release(workspace, unit, folder, user, tuple(files_in(workspace)), packages, wheels)


def only_unit(workspace: Path) -> Path:
    """Return the only unit in a workspace."""
    units = sorted(workspace.glob("*.service"))
    if len(units) != 1:
        there = ", ".join(unit.name for unit in units) or "none"
        raise click.UsageError(
            f"{workspace}: expected one systemd unit (*.service) in it, found: {there}; choose one "
            "with --unit FILE; `aionode new` writes one"
        )
    return units[0]


def place_in(unit: Path) -> tuple[PurePosixPath, str]:
    """Return the folder on the robot and the user that a unit names."""
    parser = configparser.ConfigParser(
        strict=False, interpolation=None, delimiters=("=",), comment_prefixes=("#", ";")
    )
    parser.optionxform = str  # type: ignore[assignment,method-assign]  # keys keep their case
    try:
        parser.read_string(unit.read_text(encoding="utf-8"))
    except (configparser.Error, UnicodeDecodeError) as error:
        raise click.UsageError(f"{unit}: not a systemd unit: {error!r}") from error
    place = PurePosixPath(parser.get("Service", "WorkingDirectory", fallback="").strip())
    if (
        not place.is_absolute()
        or place.name != CURRENT
        or len(place.parts) < len(("/", "opt", "name", CURRENT))
    ):
        raise click.UsageError(
            f"{unit}: WorkingDirectory={place} is not where a deployment puts a release; write "
            f"WorkingDirectory=/opt/{unit.stem}/{CURRENT}, and start programs from there: "
            f"ExecStart=/opt/{unit.stem}/{CURRENT}/.venv/bin/aionode launch …"
        )
    return place.parent, parser.get("Service", "User", fallback="root").strip() or "root"


def files_in(workspace: Path) -> Iterator[Path]:
    """Yield the files of a workspace, relative to it, except those that begin with a dot."""
    for folder, folders, files in os.walk(workspace):
        folders[:] = sorted(
            name for name in folders if not name.startswith(".") and name not in LEFT_OUT
        )
        for name in sorted(files):
            file = Path(folder, name)
            if not name.startswith(".") and file.is_file():
                yield file.relative_to(workspace)
