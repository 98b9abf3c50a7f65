"""Interfaces of folders and of the workspace around the program, read on first use.

`aionode.interfaces` looks up packages here that are not shipped, even for programs of rclpy. The
order of the folders matters only for equal names: a type may use those of any folder, of
aionode.interfaces and of the sourced ROS 2.
"""

from __future__ import annotations

import os
import warnings
from collections.abc import Iterator, Mapping
from importlib.abc import Loader
from importlib.machinery import ModuleSpec
from pathlib import Path
from threading import RLock
from types import ModuleType
from typing import Any

from aionode._packages import here
from aionode.errors import IdlError
from aionode.idl._build import Builder, existing
from aionode.idl._definition import HALVES, InterfaceText, split_type_name
from aionode.idl._folder import FileTexts, checked_stem, package_of
from aionode.interfaces import OF_ROS
from aionode.message import Interface

__all__ = [
    "NamedInterfaces",
    "add_workspace",
    "found",
    "has_sources",
    "named",
    "not_found",
    "packages",
]

VARIABLE = "AIONODE_INTERFACES"
"""The environment variable with folders of definitions, formatted like PATH."""

VARIABLES = (VARIABLE, "AMENT_PREFIX_PATH")


class NamedInterfaces:
    """The interfaces of several folders, read lazily."""

    def __init__(self) -> None:
        self._folders: set[Path] = set()
        self._new: list[Path] = []
        """The folders that have not been scanned yet."""
        self._files: dict[str, Path] = {}
        self._builder = NamedBuilder(FileTexts(self._files))
        self._lock = RLock()  # reentrant: building a type builds others

    def add(self, path: str | Path) -> None:
        """Add a folder: a package, or a folder with packages at any depth.

        Raises:
            FileNotFoundError: There is no such folder.
        """
        folder = Path(path).resolve()
        if not folder.is_dir():
            raise FileNotFoundError(f"{path}: no such folder")
        if folder not in self._folders:
            self._folders.add(folder)
            self._new.append(folder)

    def names(self, package: str) -> list[str]:
        """Return the ROS names of the types of a package."""
        return [name for name in self._known() if name.startswith(f"{package}/")]

    def packages(self) -> set[str]:
        """Return the packages of the types."""
        return {name.partition("/")[0] for name in self._known()}

    def file_of(self, typename: str, cls: type[Any]) -> Path | None:
        """Return the file that defines a class of this type, if it is in one of the folders."""
        return self._files[typename] if self._builder.built.get(typename) is cls else None

    def has(self, typename: str) -> bool:
        """Return whether one of the folders has a type."""
        return typename in self._known()

    def build(self, typename: str) -> type[Interface]:
        """Return the class of a type, created on first use.

        Raises:
            IdlError: Its definition is not valid, or uses an unknown type.
        """
        self._known()
        with self._lock:
            return self._builder.build(typename)

    def _known(self) -> Mapping[str, Path]:
        """Return the files of all types, after scanning new folders."""
        if self._new:
            with self._lock:
                while self._new:  # another thread may have done so meanwhile
                    add_definitions(self._new[0], self._files)
                    del self._new[0]
        return self._files


class NamedBuilder(Builder):
    """Creates the classes of the folders; a shipped type with the same definition is kept."""

    def __init__(self, texts: Mapping[str, InterfaceText]) -> None:
        super().__init__(texts, reuse=True)

    def existing(self, typename: str, built: type[Interface]) -> type[Interface] | None:
        """Return the shipped class of this name, if its definition is the same."""
        package = split_type_name(typename)[0]
        return existing(typename, built) if package in OF_ROS else None


def add_definitions(folder: Path, known: dict[str, Path]) -> None:
    """Add the files of a folder that define new types.

    Warns of two files that define one type differently, and of a file name that is not a type's.
    """
    for file in files_in(folder):
        try:
            typename = f"{package_of(file)}/{file.parent.name}/{checked_stem(file)}"
        except IdlError as error:  # nothing can import it
            warnings.warn(f"{error}; it is not used", RuntimeWarning, stacklevel=2)
            continue
        first = known.setdefault(typename, file)
        # A workspace may have both the source and an installed copy.
        is_another = first is not file and first.suffix == file.suffix
        if is_another and first.read_bytes() != file.read_bytes():
            text = f"{typename} is defined in {first}, and differently in {file}, which is not used"
            warnings.warn(text, RuntimeWarning, stacklevel=2)


def files_in(folder: Path) -> Iterator[Path]:
    """Yield the definition files below a folder, sorted within each folder."""
    for place, folders, files in os.walk(folder):
        folders[:] = sorted(name for name in folders if not name.startswith("."))
        kind = Path(place).name
        if kind in HALVES:
            # A file generated from another one of the same type comes after it.
            files.sort(key=lambda name: (name.endswith(".idl"), name))
            named = (Path(place, name) for name in files if is_definition(name, kind))
            yield from (file for file in named if file.is_file())


def is_definition(name: str, kind: str) -> bool:
    """Return whether a file name has the suffix of a definition and is not hidden."""
    return name.endswith((f".{kind}", ".idl")) and not name.startswith(".")


# The folders of this process

NAMED = NamedInterfaces()
"""The definitions of this process: from named folders, and from packages that were found."""

SEEN: set[str] = set()
"""The folders of the environment variable that have been added."""


def named() -> NamedInterfaces:
    """Return the definitions from the folders given to this process.

    They are those of ``--interfaces``, `aionode.rclpy.install` and AIONODE_INTERFACES, and of the
    workspace packages used so far. A folder in the variable that does not exist is left out with a
    warning.
    """
    for folder in os.environ.get(VARIABLE, "").split(os.pathsep):
        if folder and folder not in SEEN:
            SEEN.add(folder)
            try:
                NAMED.add(folder)
            except FileNotFoundError as error:
                warnings.warn(f"{VARIABLE}: {error}", RuntimeWarning, stacklevel=2)
    return NAMED


def add_workspace(package: str) -> bool:
    """Add the definitions of a workspace package, if it has any new ones."""
    source = here().sources().get(package)
    if source is None or not defines(source) or named().names(package):
        return False
    NAMED.add(source)
    return bool(NAMED.names(package))


def has_sources(package: str) -> bool:
    """Return whether the folders or the workspace define types of a package."""
    return bool(named().names(package)) or add_workspace(package)


def defines(package: Path) -> bool:
    """Return whether a package has folders with definitions."""
    return any((package / kind).is_dir() for kind in HALVES)


def packages() -> frozenset[str]:
    """Return the names of the packages with definitions in the folders and the workspace."""
    in_workspace = (name for name, source in here().sources().items() if defines(source))
    return frozenset((*named().packages(), *in_workspace))


def found(fullname: str, package: str, kind: str) -> ModuleSpec | None:
    """Return the import spec of a package of ``aionode.interfaces``, if the folders have it.

    Args:
        fullname: The name of the module.
        package: The package.
        kind: ``msg``, ``srv`` or ``action``; empty for the package itself.
    """
    names = [name for name in named().names(package) if f"/{kind}/" in name or not kind]
    if not names:
        return None
    return ModuleSpec(fullname, NamedLoader(NAMED, names if kind else []), is_package=not kind)


def not_found(fullname: str, package: str) -> ModuleNotFoundError:
    """Return the error for a package whose definitions are not found."""
    workspace = here().workspace
    places = [] if workspace is None else [f"the workspace {workspace}"]
    places += [f"{name}={os.environ[name]}" for name in VARIABLES if os.environ.get(name)]
    return ModuleNotFoundError(
        f"No module named {fullname!r}: no definitions of {package} in "
        f"{', '.join(places) or 'a workspace around the program'}; name the folder that holds "
        f"{package}: {VARIABLE}=FOLDER, or --interfaces FOLDER of aionode's commands",
        name=fullname,
    )


class NamedLoader(Loader):
    """Loads a module of types; an invalid type is left out, and raises an error when used."""

    def __init__(self, named: NamedInterfaces, names: list[str]) -> None:
        self.named = named
        self.names = names

    def exec_module(self, module: ModuleType) -> None:
        """Put the classes into the module."""
        for typename in self.names:
            name = split_type_name(typename)[2]
            try:
                vars(module)[name] = self.named.build(typename)
            except IdlError as error:
                refuse(module, name, error)


def refuse(module: ModuleType, name: str, error: IdlError) -> None:
    """Make a module raise an error when one of its types is accessed."""
    failed: dict[str, IdlError] = vars(module).setdefault("__refused__", {})
    failed[name] = error

    def find(wanted: str) -> Any:
        if wanted in failed:
            raise failed[wanted]
        raise AttributeError(f"module {module.__name__!r} has no attribute {wanted!r}")

    vars(module).update(__getattr__=find)
