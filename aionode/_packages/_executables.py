"""The executables of a package, from its source folder or its installation."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from aionode._packages._setup_files import entry_points, scripts

if TYPE_CHECKING:
    from collections.abc import Iterable

__all__ = [
    "Executable",
    "executables_in",
    "installed_executables",
    "is_python",
    "module_folders",
    "root_of",
    "runs_in_this_python",
]


class Executable(NamedTuple):
    """A program of a package.

    Attributes:
        package: The name of its package.
        name: Its name.
        target: Its file, or the function that it calls: ``module:function``.
        root: The folder with the Python modules of its package, if the target is a function.
        is_standard: Whether it is one of aionode's programs; the target is its module.
    """

    package: str
    name: str
    target: str
    root: Path | None = None
    is_standard: bool = False

    def command(self, *options: str) -> list[str]:
        """Return the command that starts it, without its own arguments.

        Args:
            *options: Options of ``python -m aionode.rclpy``, for executables in Python.
        """
        if self.is_standard:
            return [sys.executable, "-m", "aionode.programs", self.package, self.name]
        python = [sys.executable, "-m", "aionode.rclpy", *options]
        if self.root is not None:
            return [*python, "--path", str(self.root), "-m", self.target]
        return [*python, self.target] if is_python(Path(self.target)) else [self.target]


def executables_in(folder: Path, package: str) -> dict[str, Executable]:
    """Return the executables in a package's source folder, by name."""
    executables = {
        name: Executable(package, name, str(file))
        for name, file in scripts(folder, package).items()
    }
    for name, target in entry_points(folder).items():
        module = target.partition(":")[0].partition(".")[0]
        root = root_of(module, module_folders(folder))
        executables[name] = Executable(package, name, target, root or folder)
    return dict(sorted(executables.items()))


def installed_executables(prefix: Path, package: str) -> dict[str, Executable]:
    """Return the executables of a package installed below a folder, by name."""
    folder = prefix / "lib" / package
    files = sorted(folder.iterdir()) if folder.is_dir() else []
    return {
        file.name: Executable(package, file.name, str(file))
        for file in files
        if file.is_file() and os.access(file, os.X_OK)
    }


def module_folders(package: Path) -> tuple[Path, Path]:
    """Return the folders within a package's source folder that may contain its Python modules."""
    return package, package / "src"


def root_of(module: str, folders: Iterable[Path]) -> Path | None:
    """Return the first of these folders that contains a Python module, if any."""
    for folder in folders:
        if (folder / module / "__init__.py").is_file() or (folder / f"{module}.py").is_file():
            return folder
    return None


def is_python(file: Path) -> bool:
    """Return whether a file is a Python program, by its name or first line."""
    if file.suffix == ".py":
        return True
    first = first_line(file)
    return first.startswith(b"#!") and b"python" in first


def runs_in_this_python(file: Path) -> bool:
    """Return whether a file's first line names the Python that runs this process."""
    first = first_line(file)
    if not first.startswith(b"#!"):
        return False
    python = Path(os.fsdecode(first[2:].strip()))
    return "python" in python.name and python.parent == Path(sys.executable).parent


def first_line(file: Path) -> bytes:
    """Return the first line of a file, if it can name an interpreter; empty if unreadable."""
    try:
        with file.open("rb") as opened:
            return opened.readline(500)
    except OSError:
        return b""
