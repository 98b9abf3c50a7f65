"""Lists what programs import and whether it is there, without running them."""

from __future__ import annotations

import ast
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from importlib import import_module
from importlib.machinery import ModuleSpec, PathFinder
from pathlib import Path
from typing import Final

from aionode.rclpy._finder import ALIASES, KINDS, exists
from aionode.rclpy._missing import advice
from aionode.rclpy._rosidl import has_interfaces, names_in
from aionode.rclpy._workspace import around

__all__ = ["check"]

HIDDEN: Final = ("build", "install", "log", "node_modules", "site-packages")
"""Folders of a workspace in which no source lies; nor does any in those that begin with a dot."""


@dataclass(frozen=True)
class Import:
    """A module that a program imports, and the name that it takes from there, if any."""

    module: str
    name: str = ""
    optional: bool = False


@dataclass(frozen=True)
class Finding:
    """A module or name that a program imports, and where it is, or why it is not there."""

    shown: str
    where: str
    is_there: bool = True


def check(paths: Sequence[str]) -> tuple[str, bool]:
    """Return a text that lists what each file imports and from where, and whether all is there.

    The modules of Python's standard library are left out, and those that are imported for type
    checkers alone. A folder stands for the Python files in it.

    Args:
        paths: Files and folders.

    Raises:
        FileNotFoundError: There is no such file or folder.
    """
    reports = [report_on(file) for path in paths for file in files_of(Path(path))]
    return "".join(text for text, _ in reports), all(complete for _, complete in reports)


def report_on(file: Path) -> tuple[str, bool]:
    """Return the lines for one file, and whether it will find what it imports."""
    try:
        tree = ast.parse(file.read_bytes(), str(file))
    except (SyntaxError, ValueError) as error:
        return f"{file}\n  cannot be read: {error}\n", False
    listed: dict[str, str] = {}
    complete = True
    for wanted in imports_of(tree):
        if wanted.module.partition(".")[0] in sys.stdlib_module_names:
            continue
        finding = find(wanted, file)
        if finding.is_there:
            listed[finding.shown] = finding.where
            continue
        listed[finding.shown] = f"missing{', optional' * wanted.optional}: {finding.where}"
        complete = complete and wanted.optional
    width = max(map(len, listed), default=0)
    lines = [f"  {shown:{width}}  {where}" for shown, where in sorted(listed.items())]
    return "\n".join([str(file), *lines, ""]), complete


def files_of(path: Path) -> list[Path]:
    """Return a file, or the Python files of a folder."""
    if not path.is_dir():
        if not path.is_file():
            raise FileNotFoundError(f"{path}: no such file or folder")
        return [path]
    return sorted(
        file
        for file in path.rglob("*.py")
        if not any(
            part.startswith(".") or part in HIDDEN for part in file.relative_to(path).parts[:-1]
        )
    )


def imports_of(tree: ast.Module) -> list[Import]:
    """Return what a program imports, in the order of its lines, without relative imports."""
    return list(dict.fromkeys(imported(tree, optional=False)))


def imported(node: ast.AST, *, optional: bool) -> Iterator[Import]:
    """Yield what is imported in a part of a program."""
    match node:
        case ast.Import():
            yield from (Import(alias.name, optional=optional) for alias in node.names)
        case ast.ImportFrom(module=str(module), level=0):
            yield from (
                Import(module, "" if alias.name == "*" else alias.name, optional=optional)
                for alias in node.names
            )
        case ast.If() if is_for_types(node.test):
            for statement in node.orelse:
                yield from imported(statement, optional=optional)
        case ast.Try() if any(map(catches_import_error, node.handlers)):
            # The replacement of a missing module is needed only where the module is missing.
            for part in ast.iter_child_nodes(node):
                yield from imported(part, optional=True)
        case _:
            for part in ast.iter_child_nodes(node):
                yield from imported(part, optional=optional)


def is_for_types(test: ast.expr) -> bool:
    """Return whether a condition is ``TYPE_CHECKING``, alone or as an attribute of a module."""
    name = test.attr if isinstance(test, ast.Attribute) else getattr(test, "id", None)
    return name == "TYPE_CHECKING"


def catches_import_error(handler: ast.ExceptHandler) -> bool:
    """Return whether a handler catches the exception of an import that fails."""
    caught = {"ImportError", "ModuleNotFoundError", "Exception", "BaseException"}
    return handler.type is None or any(
        isinstance(part, ast.Name) and part.id in caught for part in ast.walk(handler.type)
    )


def find(wanted: Import, file: Path) -> Finding:
    """Return where an import of a file comes from."""
    module, name = wanted.module, wanted.name
    source = source_of(module)
    if source == "aionode" and name and not has_name(module, name):
        return Finding(f"{module}.{name}", f"aionode's {module} has no such name", is_there=False)
    if source is not None:
        return Finding(module, source)
    for folder in own_folders(file):
        beside = found_on([str(folder)], module)
        # A folder without Python is importable too, such as that of a message package.
        if beside is not None and beside.loader is not None:
            return Finding(module, "beside the program")
    place = in_workspace(wanted, file)
    if place is not None:
        return Finding(module, f"in {place}")
    reason = advice(module, frozenset(ALIASES)) or "no module of this name is installed"
    return Finding(module, reason, is_there=False)


def in_workspace(wanted: Import, file: Path) -> Path | None:
    """Return the package of the workspace around a file that has what the file imports."""
    package, _, inside = wanted.module.partition(".")
    packages = around(file)
    root = packages.module_root(package)
    if root is not None:
        return root if found_on([str(root)], wanted.module) else None
    source = packages.sources().get(package)
    if source is None or inside not in KINDS:
        return None
    name = wanted.name.partition("_")[0]
    return source if not name or (source / inside / f"{name}.{inside}").is_file() else None


def own_folders(file: Path) -> list[Path]:
    """Return the folder of a file, and the folder in which its package lies."""
    folder = file.resolve().parent
    top = folder
    while (top / "__init__.py").is_file():
        top = top.parent
    return [folder, top]


def source_of(module: str) -> str | None:
    """Return ``aionode``, ``installed``, or None for a module that is not there."""
    package, _, inside = module.partition(".")
    if package in ALIASES:
        own = ".".join((ALIASES[package], inside)) if inside else ALIASES[package]
        return "aionode" if exists(own) else None
    if package == "aionode":
        return "aionode" if exists(module) else None
    if has_interfaces(package):
        kind, _, _ = inside.partition(".")
        if not kind or (kind in KINDS and has_interfaces(package, kind)):
            return "aionode"
    return "installed" if found_on(None, module) else None


def found_on(path: list[str] | None, module: str) -> ModuleSpec | None:
    """Return the description of a module without importing the packages that it is in."""
    spec: ModuleSpec | None = None
    for part in module.split("."):
        spec = PathFinder.find_spec(part, path)  # the whole name would need the parent imported
        if spec is None:
            return None
        path = list(spec.submodule_search_locations or ())
    return spec


def has_name(module: str, name: str) -> bool:
    """Return whether a module of aionode has a name, be it a module in turn."""
    package, _, inside = module.partition(".")
    if package in ALIASES or package == "aionode":
        own = ".".join(filter(None, (ALIASES.get(package, package), inside)))
        return hasattr(import_module(own), name) or exists(f"{own}.{name}")
    kind = inside.partition(".")[0]
    if not kind:
        return name in KINDS and has_interfaces(package, name)
    types = {whole.split("/")[2] for whole in names_in(package) if whole.split("/")[1] == kind}
    # Words_Request and Words_Goal belong to Words; the module of Words is _words.
    return name.partition("_")[0] in {*types, ""}
