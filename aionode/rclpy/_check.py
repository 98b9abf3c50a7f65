"""Lists what programs import and whether it is available, without running them."""

from __future__ import annotations

import ast
import operator
import os
import sys
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from functools import cache
from importlib import import_module
from importlib.machinery import ModuleSpec, PathFinder
from importlib.util import find_spec
from pathlib import Path
from typing import Any, Final

from aionode._packages import Packages, around, parameter_modules
from aionode.idl.search import has_interfaces, module_name, names_in
from aionode.rclpy._finder import FINDER, KINDS, SUPPLIED, exists, gives_way
from aionode.rclpy.missing import advice

__all__ = ["check"]

HIDDEN: Final = ("build", "install", "log", "node_modules", "site-packages")
"""Folders of a workspace without sources, like those that begin with a dot."""

FACTS: Final[dict[str, Any]] = {
    "sys.version_info": tuple(sys.version_info),
    "sys.version_info[:2]": sys.version_info[:2],
    "sys.version_info[0]": sys.version_info[0],
    "sys.version_info.major": sys.version_info.major,
    "sys.version_info.minor": sys.version_info.minor,
    "sys.platform": sys.platform,
    "os.name": os.name,
}
"""The values that conditions around imports compare, for this Python and this system."""

COMPARISONS: Final[dict[type[ast.cmpop], Callable[[Any, Any], Any]]] = {
    ast.Eq: operator.eq,
    ast.NotEq: operator.ne,
    ast.Lt: operator.lt,
    ast.LtE: operator.le,
    ast.Gt: operator.gt,
    ast.GtE: operator.ge,
    ast.In: lambda value, values: value in values,
    ast.NotIn: lambda value, values: value not in values,
}

ENDS: Final = ("sys.exit", "exit", "quit", "os._exit")
"""Functions that end a program."""


@dataclass(frozen=True)
class Import:
    """A module that a program imports, and the name it imports from there, if any.

    Attributes:
        module: The module; a relative name begins with dots, as in the program.
        name: The name that is imported from it; empty if none is.
        optional: Whether the program has another way where it is missing.
        instead_of: Imports in whose place this one happens: in each set one has failed.
    """

    module: str
    name: str = ""
    optional: bool = False
    instead_of: tuple[frozenset[Import], ...] = ()


@dataclass(frozen=True)
class Finding:
    """A module or name that a program imports, and where it is or why it is missing.

    Attributes:
        shown: Its name; empty if it need not be listed.
        where: Where it is, or what is missing.
        is_there: Whether it is available.
        files: The files of one of the user's own modules, including its packages.
    """

    shown: str
    where: str
    is_there: bool = True
    files: tuple[Path, ...] = ()


@dataclass
class Report:
    """The imports of one file.

    Attributes:
        lines: A line per module.
        is_complete: Whether the file finds what it needs.
        missing: The first part of each module that is missing.
        needed: The user's files that it imports.
        optional: The user's files that it can do without.
    """

    lines: list[str]
    is_complete: bool = True
    missing: set[str] = field(default_factory=set)
    needed: list[Path] = field(default_factory=list)
    optional: list[Path] = field(default_factory=list)


def check(paths: Sequence[str]) -> tuple[str, bool]:
    """List what each file imports and from where; return the text, and whether all is available.

    Modules of Python's standard library and those imported only for type checkers are omitted. A
    folder stands for its Python files. The user's own modules that a file imports are examined too,
    and listed if they import something.

    Args:
        paths: Files and folders.

    Raises:
        FileNotFoundError: There is no such file or folder.
    """
    for cached in (resolved, own_folders, imports_in, source_of, root_of, reason):
        cached.cache_clear()  # files may have changed since an earlier check
    named = [file for path in paths for file in files_of(Path(path))]
    uses = {resolved(file): Use(file, is_needed=True) for file in named}
    reports = Reports()
    for program in list(uses.values()):
        for file, report, is_needed in reports.of_program(program.file):
            use = uses.setdefault(resolved(file), Use(file))
            use.is_needed |= is_needed
            if use is program:
                use.as_program = report
            else:
                use.as_module.append(report)
    texts = (
        "\n".join([str(use.file), *use.report.lines, ""])
        for use in uses.values()
        if use.report.lines or use.as_program is not None
    )
    return "".join(texts), all(use.report.is_complete for use in uses.values() if use.is_needed)


@dataclass
class Use:
    """The findings about a file.

    Attributes:
        file: The file.
        is_needed: Whether it is a program, or a program cannot do without it.
        as_program: Its imports, if it is run itself; None for a file that was not named.
        as_module: Its imports, for each program that imports it: they may lie beside the program.
    """

    file: Path
    is_needed: bool = False
    as_program: Report | None = None
    as_module: list[Report] = field(default_factory=list)

    @property
    def report(self) -> Report:
        """The imports that count: those of the program it is, or else of the programs it serves."""
        if self.as_program is not None and (self.as_program.is_complete or not self.as_module):
            return self.as_program
        incomplete = (report for report in self.as_module if not report.is_complete)
        return next(incomplete, self.as_module[0])


class Reports:
    """The imports of files, each read once for each folder that makes a difference."""

    def __init__(self) -> None:
        self._known: dict[tuple[Path, tuple[Path, ...]], Report] = {}

    def of_program(self, program: Path) -> Iterator[tuple[Path, Report, bool]]:
        """Yield a program and the user's modules that it imports, and whether it needs them."""
        folders = own_folders(program)
        needed, optional = deque([program]), deque[Path]()
        done: set[Path] = set()
        while needed or optional:
            is_needed = bool(needed)
            file = (needed or optional).popleft()
            if resolved(file) in done:
                continue
            done.add(resolved(file))
            report = self.of(file, folders)
            yield file, report, is_needed
            (needed if is_needed else optional).extend(report.needed)
            optional.extend(report.optional)

    def of(self, file: Path, folders: Sequence[Path]) -> Report:
        """Return the imports of a file for a program that has these folders on its path."""
        own = own_folders(file)
        report = self._read(file, tuple(own))
        if report.is_complete:
            return report
        others = (folder for folder in folders if folder not in own)
        more = [
            folder
            for folder in others
            if any(PathFinder.find_spec(name, [str(folder)]) for name in report.missing)
        ]
        return self._read(file, (*own, *more)) if more else report

    def _read(self, file: Path, folders: tuple[Path, ...]) -> Report:
        key = (resolved(file), folders)
        if key not in self._known:
            self._known[key] = report_on(file, folders)
        return self._known[key]


def report_on(file: Path, folders: Sequence[Path]) -> Report:
    """Report the imports of one file; folders are those whose modules it finds."""
    try:
        imports = imports_in(file)
    except (OSError, SyntaxError, ValueError, RecursionError, MemoryError) as error:
        return Report([f"  cannot be read: {error}"], is_complete=False)
    listed: dict[str, str] = {}
    missing: set[Import] = set()
    report = Report([])
    for wanted in imports:
        if is_in_python(wanted.module):
            continue
        optional = wanted.optional or any(missing.isdisjoint(first) for first in wanted.instead_of)
        finding = find(wanted, file, folders)
        sources = [file for file in finding.files if file.suffix == ".py"]
        (report.optional if optional else report.needed).extend(sources)
        if finding.is_there:
            listed[finding.shown] = finding.where
            continue
        missing.add(wanted)
        report.missing.add(wanted.module.partition(".")[0])
        listed[finding.shown] = f"missing{', optional' * optional}: {finding.where}"
        report.is_complete = report.is_complete and optional
    listed.pop("", None)
    width = max(map(len, listed), default=0)
    report.lines += [f"  {shown:{width}}  {where}" for shown, where in sorted(listed.items())]
    return report


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


@cache
def resolved(file: Path) -> Path:
    """Return a file without links, by which it is known however it is reached."""
    return file.resolve()


@cache
def imports_in(file: Path) -> list[Import]:
    """Return a program's imports, in the order of its lines."""
    return list(dict.fromkeys(imported(ast.parse(file.read_bytes(), str(file)), optional=False)))


def is_in_python(module: str) -> bool:
    """Return whether a module belongs to Python's library, and to that of this system."""
    top = module.partition(".")[0]
    return top in sys.stdlib_module_names and find_spec(top) is not None


def imported(node: ast.AST, *, optional: bool) -> Iterator[Import]:
    """Yield the imports in a part of a program."""
    match node:
        case ast.Import():
            yield from (Import(alias.name, optional=optional) for alias in node.names)
        case ast.ImportFrom():
            module = "." * node.level + (node.module or "")
            yield from (
                Import(module, "" if alias.name == "*" else alias.name, optional=optional)
                for alias in node.names
            )
        case ast.expr():
            yield from by_function(node, optional=optional)
        case ast.If():
            for statement in taken(node):
                yield from imported(statement, optional=optional)
        case ast.Try() if any(map(goes_on_without, node.handlers)):
            yield from tried(node, optional=optional)
        case ast.With() if any(is_suppressing(item.context_expr) for item in node.items):
            for statement in node.body:
                yield from imported(statement, optional=True)
        case _:
            for part in ast.iter_child_nodes(node):
                yield from imported(part, optional=optional)


def by_function(node: ast.expr, *, optional: bool) -> Iterator[Import]:
    """Yield the imports by calls such as `import_module` in an expression.

    An expression is walked without recursion: a sum of a thousand terms is that deep.
    """
    for part in ast.walk(node):
        match part:
            case ast.Call(
                func=ast.Name(id="import_module" | "__import__")
                | ast.Attribute(attr="import_module" | "__import__"),
                args=[ast.Constant(value=str(module)), *_],
            ):
                yield Import(module, optional=optional)


def tried(node: ast.Try, *, optional: bool) -> Iterator[Import]:
    """Yield the imports of a part of a program that goes on where one of them fails."""
    first = [each for part in node.body for each in imported(part, optional=True)]
    yield from first
    for handler in node.handlers:
        for each in imported(handler, optional=optional):
            yield replace(each, instead_of=(frozenset(first), *each.instead_of))
    for part in (*node.orelse, *node.finalbody):
        yield from imported(part, optional=True)


def taken(node: ast.If) -> list[ast.stmt]:
    """Return the statements below a condition that may run here."""
    holds = known(node.test)
    return node.body * (holds is not False) + node.orelse * (holds is not True)


def known(test: ast.expr) -> bool | None:
    """Return what a condition about Python or the system is here; None for any other."""
    match test:
        case ast.Constant():
            return bool(test.value)
        case ast.Name(id="TYPE_CHECKING") | ast.Attribute(attr="TYPE_CHECKING"):
            return False
        case ast.UnaryOp(op=ast.Not(), operand=inner):
            holds = known(inner)
            return None if holds is None else not holds
        case ast.Call(func=ast.Attribute(attr="startswith"), args=[ast.Constant(value=str(head))]):
            return sys.platform.startswith(head) if "sys.platform" in ast.unparse(test) else None
        case ast.Compare(left=left, ops=[op], comparators=[right]):
            fact, compare = FACTS.get(ast.unparse(left)), COMPARISONS.get(type(op))
            if fact is not None and compare is not None:
                with suppress(ValueError, TypeError):
                    return bool(compare(fact, ast.literal_eval(right)))
    return None


def goes_on_without(handler: ast.ExceptHandler) -> bool:
    """Return whether a program that cannot import something goes on after a handler."""
    return catches_import_error(handler.type) and not any(
        isinstance(last, ast.Raise)
        or (
            isinstance(last, ast.Expr)
            and isinstance(last.value, ast.Call)
            and ast.unparse(last.value.func) in ENDS
        )
        for last in handler.body
    )


def catches_import_error(caught: ast.expr | None) -> bool:
    """Return whether a handler catches a failed import."""
    names = {"ImportError", "ModuleNotFoundError", "Exception", "BaseException"}
    return caught is None or any(
        isinstance(part, ast.Name) and part.id in names for part in ast.walk(caught)
    )


def is_suppressing(entered: ast.expr) -> bool:
    """Return whether a context manager is ``suppress(ImportError)``."""
    if not isinstance(entered, ast.Call):
        return False
    name = ast.unparse(entered.func).rpartition(".")[2]
    return name == "suppress" and any(map(catches_import_error, entered.args))


def find(wanted: Import, file: Path, folders: Sequence[Path]) -> Finding:
    """Find where an import of a file comes from."""
    if wanted.module.startswith("."):
        return beside(wanted, file)
    module, name = wanted.module, wanted.name
    source = source_of(module)
    if source == "aionode":
        return in_aionode(module, name)
    if source is not None:
        return Finding(module, source)
    for folder in folders:
        if files := files_on(folder, module, name):
            return Finding(module, "beside the program", files=files)
    package, _, inside = module.partition(".")
    packages = around(file.parent)
    root = root_of(packages, package)
    place = packages.sources().get(package)
    if root is not None and (files := files_on(root, module, name)):
        return Finding(module, f"in {root}", files=files)
    if place is not None and inside in KINDS:
        interface = name.partition("_")[0]
        if not name or (place / inside / f"{interface}.{inside}").is_file():
            return Finding(module, f"in {place}")
    if place is not None and inside in parameter_modules(place, package):
        return Finding(module, f"of the parameters in {place}")
    return Finding(module, reason(module), is_there=False)


@cache
def root_of(packages: Packages, module: str) -> Path | None:
    """Return the folder from which a module of a workspace is imported."""
    return packages.module_root(module)


@cache
def reason(module: str) -> str:
    """Return why a module is missing, and what to do."""
    package = module.partition(".")[0]
    supplied = SUPPLIED | ({package} if has_interfaces(package) else set())
    return advice(module, supplied) or "no module of this name is installed"


def in_aionode(module: str, name: str) -> Finding:
    """Return whether a module of aionode has a name, or what it lacks."""
    try:
        if not name or has_name(module, name):
            if is_module_here(module):
                import_module(module)
            return Finding(module, "aionode")
    except ImportError as error:  # such as rosbag2_py without the bag extra
        return Finding(module, str(error), is_there=False)
    return Finding(f"{module}.{name}", f"aionode's {module} has no such name", is_there=False)


def beside(wanted: Import, file: Path) -> Finding:
    """Resolve a relative import; it is listed only if it fails."""
    module = wanted.module.lstrip(".")
    level = len(wanted.module) - len(module)
    above = resolved(file).parents
    folder = above[min(level, len(above)) - 1]
    files = files_on(folder, module, wanted.name)
    if module and not files:
        return Finding(wanted.module, f"no such module in {folder}", is_there=False)
    return Finding("", "", files=files)


@cache
def own_folders(file: Path) -> list[Path]:
    """Return the folder of a file, and the folder that contains its package."""
    folder = resolved(file).parent
    top = folder
    while (top / "__init__.py").is_file():
        top = top.parent
    return [folder, top]


@cache
def source_of(module: str) -> str | None:
    """Return ``aionode``, ``installed``, or None for a missing module."""
    package = module.partition(".")[0]
    if is_module_here(module) and not gives_way(package):
        return "aionode" if exists(module) else None
    if has_interfaces(package) and FINDER.find_spec(module, None) is not None:
        return "aionode"
    return "installed" if specs_on(None, module) else None


def is_module_here(module: str) -> bool:
    """Return whether a module belongs to a Python package that aionode provides."""
    return module.partition(".")[0] in {*SUPPLIED, "aionode"}


def specs_on(path: list[str] | None, module: str) -> list[ModuleSpec]:
    """Return the specs of a module and its parent packages, without importing them."""
    specs: list[ModuleSpec] = []
    for part in module.split("."):
        spec = PathFinder.find_spec(part, path)  # the full name would import the parent
        if spec is None:
            return []
        specs.append(spec)
        path = list(spec.submodule_search_locations or ())
    return specs


def files_on(folder: Path, module: str, name: str) -> tuple[Path, ...]:
    """Return the Python files of a module below a folder, and of a name that is a submodule.

    A folder without Python, such as a message package, is importable too but does not count.
    """
    whole = [f"{module}.{name}".strip("."), module] if name else [module]
    for wanted in filter(None, whole):
        specs = specs_on([str(folder)], wanted)
        files = tuple(Path(spec.origin) for spec in specs if spec.has_location and spec.origin)
        if specs and specs[-1].has_location:
            return files
    return ()


def has_name(module: str, name: str) -> bool:
    """Return whether a module of aionode has a name, which may be a submodule."""
    if is_module_here(module):
        return hasattr(import_module(module), name) or exists(f"{module}.{name}")
    package, _, inside = module.partition(".")
    kind = inside.partition(".")[0]
    if not kind:
        return name in KINDS and has_interfaces(package, name)
    types = {whole.split("/")[2] for whole in names_in(package) if whole.split("/")[1] == kind}
    # Words_Request and Words_Goal belong to Words; the module of Words is _words.
    if inside != kind:
        return name.partition("_")[0] in {
            part for part in types if module_name(package, kind, part) == module
        }
    return name.partition("_")[0] in {*types, ""}
