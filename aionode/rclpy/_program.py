"""Runs an rclpy program as Python would: as ``__main__``, with its arguments and traceback."""

from __future__ import annotations

import builtins
import sys
from collections.abc import Iterator, Sequence
from importlib.machinery import ModuleSpec, SourceFileLoader
from importlib.util import find_spec
from pathlib import Path
from types import CodeType, ModuleType, TracebackType
from typing import Any, NamedTuple, NoReturn

from aionode.errors import AionodeError

__all__ = ["main"]

USAGE = """\
usage: python -m aionode.rclpy [OPTION...] PROGRAM.py [ARGUMENT...]
       python -m aionode.rclpy [OPTION...] -m MODULE[:FUNCTION] [ARGUMENT...]
       python -m aionode.rclpy [OPTION...] --check (PROGRAM.py | FOLDER)...

Runs a program that imports rclpy, with aionode in the place of ROS 2.

  --interfaces FOLDER  message packages that the program uses; may be repeated
  --workspace FOLDER   the packages that the program uses; else those around the program
  --stand-ins          a package that is not there has a folder that does not exist
  --path FOLDER        where modules are looked for, in the place of the current folder
  -m MODULE            run a module, as python -m does; with :FUNCTION, call that function, as
                       the executable of a package does
  --check              run nothing: list what programs import, and whether it is there; the exit
                       status is 1 if something is missing
"""


CHECK = "--check"
STAND_INS = "--stand-ins"
FOLDERS = ("--interfaces", "--workspace", "--path")
"""The options that take a folder."""


class Parsed(NamedTuple):
    """The arguments of a command line.

    Attributes:
        folders: The folders of each option.
        is_module: Whether to run a module rather than a file.
        name: The name of the module or file; ``--check`` if nothing is run.
        arguments: The remaining arguments.
    """

    folders: dict[str, list[str]]
    is_module: bool
    name: str
    arguments: list[str]


def main(argv: Sequence[str]) -> None:
    """Run the program named by the arguments; the process ends with it.

    Raises:
        SystemExit: There is no such program, or an argument is missing.
    """
    folders, is_module, name, arguments = parsed(argv)
    # not loaded for the usage text
    from aionode.rclpy._children import let_children_import
    from aionode.rclpy._defects import prepare
    from aionode.rclpy._finder import install, shared_errors_take_names

    workspace = folders["--workspace"][-1] if folders["--workspace"] else None
    try:
        install(interfaces=folders["--interfaces"], workspace=workspace)
    except (AionodeError, OSError) as error:
        fail(str(error))
    if sys.flags.safe_path:
        sys.path.insert(0, "")  # what `python -P` leaves out, and what is replaced below
    if name == CHECK:
        list_imports(arguments)
    sys.path[:1] = folders["--path"] or sys.path[:1]
    let_children_import(folders["--interfaces"])
    shared_errors_take_names()
    prepare(name)
    sys.excepthook = report
    code, module = (of_module if is_module else of_file)(name)
    sys.argv = [str(module.__file__) if is_module else name, *arguments]
    sys.modules["__main__"] = module
    exec(code, vars(module))  # noqa: S102 (the program)


def parsed(argv: Sequence[str]) -> Parsed:
    """Parse the arguments; a usage text ends the process."""
    given = list(argv)
    folders: dict[str, list[str]] = {option: [] for option in FOLDERS}
    while given:
        first = given.pop(0)
        if first in {"-h", "--help"}:
            sys.stdout.write(USAGE)
            raise SystemExit(0)
        if first == STAND_INS:
            from aionode._packages import use_stand_ins  # for the commands of launch files

            use_stand_ins(wanted=True)
        elif first in FOLDERS and given:
            folders[first].append(given.pop(0))
        elif first == CHECK and given:
            return Parsed(folders, False, CHECK, given)
        elif first == "-m" and given:
            return Parsed(folders, True, given[0], given[1:])
        elif first.startswith("-"):
            break
        else:
            return Parsed(folders, False, first, given)
    sys.stderr.write(USAGE)
    raise SystemExit(2)


def list_imports(paths: Sequence[str]) -> NoReturn:
    """Print what programs import and whether it is available, without running them.

    Raises:
        SystemExit: With status 1 if something is missing.
    """
    from aionode.rclpy._check import check  # not needed to run programs

    del sys.path[0]  # the current folder, where programs do not look
    try:
        text, complete = check(paths)
    except OSError as error:
        fail(str(error))
    sys.stdout.write(text)
    raise SystemExit(0 if complete else 1)


def of_file(name: str) -> tuple[CodeType, ModuleType]:
    """Compile a file; return its code and the module in which it runs."""
    path = Path(name)
    try:
        source = path.read_bytes()
    except OSError as error:
        fail(f"can't open file {name!r}: {error.strerror}")
    sys.path[0] = str(path.resolve().parent)
    file = str(path.absolute())  # as of Python 3.9
    module = ModuleType("__main__")
    loader = SourceFileLoader("__main__", file)
    vars(module).update(__file__=file, __loader__=loader, __spec__=None, __builtins__=builtins)
    code = compile(source, file, "exec", dont_inherit=True)  # as Python does
    if only_defines_main(source):
        fail(f"{name} defines main() and does not call it; --path FOLDER -m MODULE:main does")
    return code, module


def of_module(name: str) -> tuple[CodeType, ModuleType]:
    """Return the code of a module, or of the ``__main__`` of a package, and its module.

    With a colon and a function, the code calls that.
    """
    name, _, function = name.partition(":")
    try:
        spec = find_spec(name)
        if spec is not None and spec.submodule_search_locations is not None:
            spec = find_spec(f"{name}.__main__")
    except ModuleNotFoundError as error:
        fail(no_module(error.name or name))
    code = code_of(spec)
    if spec is None or code is None:
        fail(no_module(name))
    if function:
        code = code_of_call(name, function)
    elif only_defines_main(source_of(spec)):
        fail(f"{name} defines main() and does not call it; -m {name}:main does")
    module = ModuleType("__main__")
    vars(module).update(
        __file__=spec.origin,
        __loader__=spec.loader,
        __spec__=spec,
        __package__=spec.parent,
        __builtins__=builtins,
    )
    return code, module


def code_of(spec: ModuleSpec | None) -> CodeType | None:
    """Return the code of a module, if it has any."""
    loader: Any = spec and spec.loader
    if spec is None or not hasattr(loader, "get_code"):
        return None
    code: CodeType | None = loader.get_code(spec.name)
    return code


def code_of_call(module: str, function: str) -> CodeType:
    """Return code that exits with the result of a function, like a package's executable."""
    if not all(part.isidentifier() for part in (*module.split("."), *function.split("."))):
        fail(f"{module}:{function} is not MODULE:FUNCTION")
    source = f"import sys\nfrom {module} import {function.partition('.')[0]}\n"
    source += f"sys.exit({function}())\n"
    return compile(source, f"{module}:{function}", "exec", dont_inherit=True)


def no_module(name: str) -> str:
    """Return the error text for a missing module: where it was searched, and the closest name."""
    import difflib  # only for an error text
    import pkgutil

    from aionode._packages import here

    above, _, last = name.rpartition(".")
    folders = [sys.path[0]] if not above else getattr(sys.modules.get(above), "__path__", ())
    known = {module.name for module in pkgutil.iter_modules(folders)}
    if not above:
        known.update(here().sources())
    near = difflib.get_close_matches(last, known, 1)
    dot = f"{above}." if above else ""
    hint = f"; did you mean {dot}{near[0]}?" if near else ""
    places = [str(Path(sys.path[0] or ".").resolve()), "PYTHONPATH"]
    workspace = here().workspace
    places += [] if workspace is None else [f"the packages of {workspace}"]
    return f"No module named {name}, looked for in {', '.join(places)}{hint}"


def source_of(spec: ModuleSpec) -> bytes:
    """Return the source of a module; empty if unavailable."""
    loader: Any = spec.loader
    source = loader.get_source(spec.name) if hasattr(loader, "get_source") else None
    return (source or "").encode()


def only_defines_main(source: bytes) -> bool:
    """Return whether a program only defines a function ``main`` and does nothing when run."""
    if b"main" not in source or b"__main__" in source:
        return False
    import ast  # takes as long as a small program

    quiet = (ast.Import, ast.ImportFrom, ast.FunctionDef, ast.ClassDef, ast.Assign, ast.AnnAssign)
    statements = ast.parse(source).body
    is_quiet = all(
        isinstance(statement, quiet)
        or (isinstance(statement, ast.Expr) and isinstance(statement.value, ast.Constant))
        for statement in statements
    )
    return is_quiet and any(
        isinstance(statement, ast.FunctionDef) and statement.name == "main"
        for statement in statements
    )


def fail(problem: str) -> NoReturn:
    """Exit with a line on standard error."""
    sys.stderr.write(f"aionode.rclpy: {problem}\n")
    raise SystemExit(2)


def report(
    kind: type[BaseException], error: BaseException, traceback: TracebackType | None
) -> None:
    """Print an uncaught exception of the program, without the lines of its runner.

    For a missing ROS module, advice follows.
    """
    own = [entry for entry in entries(traceback) if entry.tb_frame.f_globals is globals()]
    if own:
        error = error.with_traceback(own[-1].tb_next)
    sys.__excepthook__(kind, error, error.__traceback__)
    if isinstance(error, Exception):
        advise(error)


def advise(error: Exception) -> None:
    """Print advice about the ROS modules that an exception did not find."""
    from aionode.idl.search import has_interfaces
    from aionode.rclpy._finder import SUPPLIED
    from aionode.rclpy.missing import advice, missing_modules

    for module in missing_modules(error):
        text = advice(module, SUPPLIED)
        if text is not None and not has_interfaces(module.partition(".")[0]):
            sys.stderr.write(f"aionode.rclpy: {text}\n")


def entries(traceback: TracebackType | None) -> Iterator[TracebackType]:
    """Yield the entries of a traceback, the outermost call first."""
    while traceback is not None:
        yield traceback
        traceback = traceback.tb_next
