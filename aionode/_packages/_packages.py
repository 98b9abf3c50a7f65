"""The packages that a program can refer to, and their executables."""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence
from itertools import chain
from pathlib import Path

from aionode._packages._executables import (
    Executable,
    executables_in,
    installed_executables,
    module_folders,
    root_of,
    runs_in_this_python,
)
from aionode._packages._setup_files import import_folders
from aionode._packages._share import share_of
from aionode._packages._standard import (
    is_window,
    remark_on,
    standard_executables,
    standard_packages,
    standard_plugin,
    standard_share,
)
from aionode._packages._workspace import Sources, sources_in
from aionode.errors import ExecutableNotFoundError, PackageNotFoundError

__all__ = ["Packages"]

MARKER = Path("share", "ament_index", "resource_index", "packages")
"""The folder below a prefix in which each installed package has a file with its name."""


class Packages:
    """The packages of a workspace, and the installed ones.

    Args:
        workspace: The folder with the packages, or a package itself; if it has a folder ``src``,
            only that is used. Without one, only installed packages are known.

    Raises:
        FileNotFoundError: There is no such folder.
    """

    def __init__(self, workspace: Path | None = None) -> None:
        if workspace is not None and not workspace.is_dir():
            raise FileNotFoundError(f"{workspace}: no such folder; a workspace is a folder")
        self.workspace = None if workspace is None else source_folder(workspace.resolve())

    def sources(self) -> dict[str, Path]:
        """Return the source folders of the workspace's packages, by name."""
        return self._found().packages

    def share(self, name: str) -> Path:
        """Return the share folder of a package, with its data as installed.

        For a package of the workspace that is its source folder, or a folder of links to its files.
        For one of ROS that is not there it is what aionode has of it.

        Raises:
            PackageNotFoundError: There is no such package; the error suggests similar names.
        """
        source = self.sources().get(name)
        if source:
            return share_of(source, name)
        standard = None if self.has(name) else standard_share(name)
        return standard or self.prefix(name) / "share" / name

    def prefix(self, name: str) -> Path:
        """Return the prefix into which a package is installed.

        Raises:
            PackageNotFoundError: It is not installed.
        """
        prefix = installed_at(name)
        if prefix is None:
            raise self.not_found(name)
        return prefix

    def names(self) -> list[str]:
        """Return the names of all packages."""
        folders = [prefix / MARKER for prefix in prefixes()]
        installed = {
            file.name for folder in folders if folder.is_dir() for file in folder.iterdir()
        }
        return sorted(installed.union(self.sources()))

    def executables(self, name: str) -> dict[str, Executable]:
        """Return the executables of a package, by name; its source precedes installed ones.

        For a ROS package that is not installed, aionode's own versions stand in for its programs:
        for all of them if it is not there, or for those in C++ that nobody has built.

        Raises:
            PackageNotFoundError: There is no such package.
        """
        source = self.sources().get(name)
        prefix = installed_at(name)
        if source is None and prefix is None:
            if name in standard_packages():
                return standard_executables(name)
            raise self.not_found(name, standard_packages())
        installed = (
            standard_executables(name) if prefix is None else installed_executables(prefix, name)
        )
        return installed | ({} if source is None else executables_in(source, name))

    def has(self, name: str) -> bool:
        """Return whether there is a package, in the workspace or installed."""
        return name in self.sources() or installed_at(name) is not None

    def plugin(self, package: str, name: str) -> tuple[str, str] | None:
        """Return the node class of aionode that stands in for a plugin in C++, and its node's name.

        None if aionode has none, or if the package is installed.
        """
        return None if installed_at(package) else standard_plugin(package, name)

    def executable(self, package: str, name: str) -> Executable:
        """Return an executable of a package.

        Raises:
            PackageNotFoundError: There is no such package.
            ExecutableNotFoundError: The package has no executable of this name.
        """
        is_one_window = is_window(package, name) and not is_window(package)
        known = {} if is_one_window and not self.has(package) else self.executables(package)
        if name not in known:
            raise ExecutableNotFoundError(
                package, name, self._place(package), tuple(known), remark_on(package)
            )
        return known[name]

    def command(self, package: str, name: str, options: Sequence[str] = ()) -> list[str]:
        """Return the command that starts an executable of a package, without its arguments.

        A Python program runs with aionode's rclpy, any other as is.

        Args:
            package: The name of the package.
            name: The name of the executable.
            options: Options of ``python -m aionode.rclpy``, for Python programs.

        Raises:
            PackageNotFoundError: There is no such package.
            ExecutableNotFoundError: The package has no executable of this name.
        """
        program = self.executable(package, name)
        if package in self.sources():
            options = (*self._options(), *options)
        return program.command(*options)

    def starter(self, program: Path, options: Sequence[str] = ()) -> list[str]:
        """Return the command that starts a program which may look for packages.

        One installed for this Python, such as xacro from PyPI, runs with aionode's rclpy, so that
        it finds the packages of the workspace. Any other runs as is.

        Args:
            program: The file of the program.
            options: Options of ``python -m aionode.rclpy``, if it runs under that.
        """
        if runs_in_this_python(program):
            return [sys.executable, "-m", "aionode.rclpy", *self._options(), *options, str(program)]
        return [str(program)]

    def _place(self, package: str) -> str | None:
        """Return the folder with the executables of a package; None if it is not there."""
        try:
            return str(self.sources().get(package) or self.prefix(package) / "lib" / package)
        except PackageNotFoundError:
            return None

    def _options(self) -> tuple[str, ...]:
        """Return the options that tell a program of the workspace."""
        return () if self.workspace is None else ("--workspace", str(self.workspace))

    def module_root(self, module: str) -> Path | None:
        """Return the folder from which a Python module of the workspace is imported.

        ROS packages come first, then other Python projects, which are importable as after
        ``pip install -e``. A ``setup.py`` is no module: it would run at its import.
        """
        if module == "setup":
            return None
        sources, projects = self._found()
        folders = [sources[module]] if module in sources else []
        folders += [folder for name, folder in sources.items() if name != module]
        return root_of(
            module,
            chain.from_iterable(chain(map(module_folders, folders), map(import_folders, projects))),
        )

    def _found(self) -> Sources:
        """Return what is in the workspace."""
        return Sources({}, []) if self.workspace is None else sources_in(self.workspace)

    def not_found(self, name: str, supplied: Sequence[str] = ()) -> PackageNotFoundError:
        """Return the error for a package that is not there, or supplied by aionode."""
        places = [] if self.workspace is None else [str(self.workspace)]
        places += map(str, prefixes())
        return PackageNotFoundError(
            name, tuple(places), self.names(), remark_on(name), supplied=supplied
        )


def source_folder(workspace: Path) -> Path:
    """Return the folder of a workspace that contains the packages."""
    inner = workspace / "src"
    return inner if inner.is_dir() and not (workspace / "package.xml").is_file() else workspace


def installed_at(name: str) -> Path | None:
    """Return the prefix into which a package is installed, if it is."""
    return next((folder for folder in prefixes() if (folder / MARKER / name).is_file()), None)


def prefixes() -> list[Path]:
    """Return the prefixes of installed packages: those of ROS, then Python's own."""
    named = os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep)
    paths = dict.fromkeys((*named, sys.prefix))
    return [Path(path) for path in paths if path and Path(path).is_dir()]
