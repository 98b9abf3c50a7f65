"""Loads the interfaces of a folder of ROS packages at run time."""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path
from types import ModuleType
from typing import Any

import aionode.interfaces
from aionode._process.bounded_files import read_file
from aionode.errors import IdlError
from aionode.idl._build import Builder
from aionode.idl._definition import HALVES, InterfaceText, split_type_name
from aionode.idl._omg import parse_idl
from aionode.idl._parser import parse

__all__ = ["FileTexts", "Interfaces", "load_interfaces", "read_folder"]

PACKAGE_NAME = re.compile(r"[a-z][a-z0-9_]*")
TYPE_NAME = re.compile(r"[A-Z][A-Za-z0-9]*")


class Interfaces(Mapping[str, type[Any]]):
    """Interfaces by their ROS name, and as attributes: ``loaded.my_msgs.msg.Words``.

    Args:
        types: The classes.
    """

    def __init__(self, types: Mapping[str, type[Any]]) -> None:
        self._types = dict(sorted(types.items()))
        self._packages: dict[str, ModuleType] = {}
        for typename, cls in self._types.items():
            setattr(self._module_of(typename), typename.rpartition("/")[2], cls)

    def _module_of(self, typename: str) -> ModuleType:
        package, kind, _ = split_type_name(typename)
        outer = self._packages.setdefault(package, ModuleType(package))
        if not hasattr(outer, kind):
            setattr(outer, kind, ModuleType(f"{package}.{kind}"))
        module: ModuleType = getattr(outer, kind)
        return module

    def __getitem__(self, typename: str) -> type[Any]:
        return self._types[typename]

    def __iter__(self) -> Iterator[str]:
        return iter(self._types)

    def __len__(self) -> int:
        return len(self._types)

    def __getattr__(self, package: str) -> ModuleType:
        try:
            return self._packages[package]
        except KeyError:
            known = ", ".join(self._packages) or "none"
            raise AttributeError(
                f"package {package!r} was not loaded; loaded packages: {known}"
            ) from None

    def __repr__(self) -> str:
        return (
            f"Interfaces({len(self._types)} types of {', '.join(self._packages) or 'no package'})"
        )


def load_interfaces(path: str | Path, *, reuse: bool = True) -> Interfaces:
    """Load the interfaces of a folder as classes, without a build step.

    The folder is a package with ``msg``, ``srv`` or ``action`` folders, or contains packages at any
    depth, like a workspace or ``share``. Types that they use are looked up in the folder first,
    then in aionode.interfaces. Afterwards new packages can be imported as
    ``aionode.interfaces.my_msgs.msg``, and `aionode.interfaces.get_interface` finds them.

    Args:
        path: The folder.
        reuse: Return the existing class for a type with the same definition, so that either's
            messages are accepted everywhere; otherwise every class is new.

    Raises:
        IdlError: A definition is not valid; the error names file, line and column.
        FileNotFoundError: The folder does not exist.
    """
    files = definition_files(path)
    builder = Builder(FileTexts(files), reuse=reuse)
    loaded = Interfaces({typename: builder.build(typename) for typename in files})
    for package in {split_type_name(typename)[0] for typename in files}:
        make_importable(package, loaded)
    return loaded


class FileTexts(Mapping[str, InterfaceText]):
    """Definitions by type name, each parsed on first use."""

    def __init__(self, files: Mapping[str, Path]) -> None:
        self._files = files
        self._parsed: dict[str, InterfaceText] = {}

    def __getitem__(self, typename: str) -> InterfaceText:
        if typename not in self._parsed:
            file = self._files[typename]
            parse_text = parse_idl if file.suffix == ".idl" else parse
            self._parsed[typename] = parse_text(typename, read(file), str(file))
        return self._parsed[typename]

    def __contains__(self, typename: object) -> bool:
        return typename in self._files

    def __iter__(self) -> Iterator[str]:
        return iter(self._files)

    def __len__(self) -> int:
        return len(self._files)


def read_folder(path: str | Path) -> Mapping[str, InterfaceText]:
    """Parse the definitions of a folder; return them by type name.

    Raises:
        IdlError: A definition is not valid, or two definitions of the same type differ.
        FileNotFoundError: The folder does not exist.
    """
    texts = FileTexts(definition_files(path))
    return {typename: texts[typename] for typename in texts}


def definition_files(path: str | Path) -> dict[str, Path]:
    """Find the definition files of a folder; return them by type name.

    Raises:
        IdlError: A name is not valid, or two definitions of the same type differ.
        FileNotFoundError: The folder does not exist.
    """
    root = Path(path).resolve()
    if not root.is_dir():
        raise FileNotFoundError(f"{path}: no such folder")
    files: dict[str, Path] = {}
    # A file generated from another one of the same type comes after it.
    for kind, ending in [*((kind, kind) for kind in HALVES), *((kind, "idl") for kind in HALVES)]:
        for file in sorted(root.rglob(f"*.{ending}")):
            if file.parent.name != kind:
                continue
            typename = f"{package_of(file)}/{kind}/{checked_stem(file)}"
            expect_same(typename, files.setdefault(typename, file), file)
    return files


def expect_same(typename: str, first: Path, file: Path) -> None:
    """Raise `IdlError` if two files define one type differently."""
    # A workspace may have both the source and an installed copy.
    if first is not file and first.suffix == file.suffix and read(first) != read(file):
        raise IdlError(str(file), 0, 0, f"{typename} is defined differently in {first}")


def read(file: Path) -> str:
    """Read the text of a file.

    Raises:
        IdlError: It is not UTF-8, too large, or not a file.
    """
    try:
        data = read_file(file)
    except FileNotFoundError:
        raise
    except OSError as error:
        raise IdlError(str(file), 0, 0, f"cannot be read: {error.strerror}") from error
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        raise IdlError(str(file), line, 0, f"not UTF-8: {error.reason}") from error


def package_of(file: Path) -> str:
    """Return the package of a file: from package.xml if it exists, else from its folder."""
    folder = file.parent.parent
    manifest = folder / "package.xml"
    name = folder.name
    if manifest.is_file():
        match = re.search(r"<name>\s*([^<\s]+)\s*</name>", manifest.read_text(errors="replace"))
        name = match[1] if match else name
    if not PACKAGE_NAME.fullmatch(name):
        problem = f"{name!r} is not a valid package name; use lower-case letters, digits and _"
        raise IdlError(str(file), 0, 0, problem)
    return name


def checked_stem(file: Path) -> str:
    """Return the type name in a file name."""
    if not TYPE_NAME.fullmatch(file.stem):
        problem = f"{file.stem!r} is not a valid type name; use letters and digits, a capital first"
        raise IdlError(str(file), 0, 0, problem)
    return file.stem


def make_importable(package: str, loaded: Interfaces) -> None:
    """Make a loaded package importable, unless aionode ships that package in that release."""
    name = f"aionode.interfaces.{package}"
    if package in aionode.interfaces.OF_ROS:
        return
    module = getattr(loaded, package)
    module.__name__ = name
    module.__path__ = []
    sys.modules[name] = module
    setattr(aionode.interfaces, package, module)
    for kind in HALVES:
        if hasattr(module, kind):
            inner = getattr(module, kind)
            inner.__name__ = f"{name}.{kind}"
            sys.modules[inner.__name__] = inner
