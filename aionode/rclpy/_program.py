"""Runs a program of rclpy as Python would: as ``__main__``, with its arguments and traceback."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence
from importlib.machinery import ModuleSpec, SourceFileLoader
from importlib.util import find_spec
from pathlib import Path
from types import CodeType, ModuleType, TracebackType
from typing import Any, NoReturn

from aionode.errors import AionodeError

__all__ = ["main"]

USAGE = """\
usage: python -m aionode.rclpy [--interfaces FOLDER] PROGRAM.py [ARGUMENT...]
       python -m aionode.rclpy [--interfaces FOLDER] -m MODULE[:FUNCTION] [ARGUMENT...]
       python -m aionode.rclpy [--interfaces FOLDER] --check (PROGRAM.py | FOLDER)...

Runs a program that imports rclpy, with aionode in the place of ROS 2.

  --interfaces FOLDER  message packages that the program uses; may be repeated
  -m MODULE            run a module, as python -m does; with :FUNCTION, call that function, as
                       the executable of a package does
  --check              run nothing: list what programs import, and whether it is there; the exit
                       status is 1 if something is missing
"""


CHECK = "--check"


def main(argv: Sequence[str]) -> None:
    """Run the program that the arguments name; its end is the end of the process.

    Raises:
        SystemExit: There is no such program, or an argument is missing.
    """
    folders, is_module, name, arguments = parsed(argv)
    from aionode.rclpy._finder import install  # not to be loaded for a usage text

    try:
        install(interfaces=folders)
    except (AionodeError, OSError) as error:
        fail(str(error))
    if name == CHECK:
        list_imports(arguments)
    sys.excepthook = report
    code, module = (of_module if is_module else of_file)(name)
    sys.argv = [str(module.__file__), *arguments]
    sys.modules["__main__"] = module
    exec(code, vars(module))  # noqa: S102 (the program)


def parsed(argv: Sequence[str]) -> tuple[list[str], bool, str, list[str]]:
    """Return folders of interfaces, whether a module is run, its or the file's name, the rest."""
    given = list(argv)
    folders: list[str] = []
    while given:
        first = given.pop(0)
        if first in {"-h", "--help"}:
            sys.stdout.write(USAGE)
            raise SystemExit(0)
        if first == "--interfaces" and given:
            folders.append(given.pop(0))
        elif first == CHECK and given:
            return folders, False, CHECK, given
        elif first == "-m" and given:
            return folders, True, given[0], given[1:]
        elif first.startswith("-"):
            break
        else:
            return folders, False, first, given
    sys.stderr.write(USAGE)
    raise SystemExit(2)


def list_imports(paths: Sequence[str]) -> NoReturn:
    """Print what programs import and whether it is there; nothing of them is run.

    Raises:
        SystemExit: With status 1 if something is missing.
    """
    from aionode.rclpy._check import check  # which programs that run do not need

    del sys.path[0]  # the current folder, which is not where a program looks
    try:
        text, complete = check(paths)
    except OSError as error:
        fail(str(error))
    sys.stdout.write(text)
    raise SystemExit(0 if complete else 1)


def of_file(name: str) -> tuple[CodeType, ModuleType]:
    """Return the code of a file, and the module in which it runs."""
    path = Path(name)
    try:
        source = path.read_bytes()
    except OSError as error:
        fail(f"can't open file {name!r}: {error.strerror}")
    sys.path[0] = str(path.resolve().parent)
    module = ModuleType("__main__")
    loader = SourceFileLoader("__main__", name)
    vars(module).update(__file__=name, __loader__=loader, __spec__=None, __builtins__=__builtins__)
    return compile(source, name, "exec"), module


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
        fail(f"No module named {error.name}")
    code = code_of(spec)
    if spec is None or code is None:
        fail(f"No module named {name}")
    if function:
        code = code_of_call(name, function)
    elif only_defines_main(spec):
        fail(f"{name} defines main() and does not call it; -m {name}:main does")
    module = ModuleType("__main__")
    vars(module).update(
        __file__=spec.origin,
        __loader__=spec.loader,
        __spec__=spec,
        __package__=spec.parent,
        __builtins__=__builtins__,
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
    """Return code that ends with the result of a function, as the executable of a package does."""
    if not all(part.isidentifier() for part in (*module.split("."), *function.split("."))):
        fail(f"{module}:{function} is no MODULE:FUNCTION")
    source = f"import sys\nfrom {module} import {function.partition('.')[0]}\n"
    return compile(f"{source}sys.exit({function}())\n", f"{module}:{function}", "exec")


def only_defines_main(spec: ModuleSpec) -> bool:
    """Return whether a module defines a function ``main``, and does nothing when it is run."""
    loader: Any = spec.loader
    source = loader.get_source(spec.name) if hasattr(loader, "get_source") else None
    if source is None or "main" not in source:
        return False
    import ast  # which takes as long as a small program does

    quiet = (ast.Import, ast.ImportFrom, ast.FunctionDef, ast.ClassDef, ast.Assign, ast.AnnAssign)
    statements = ast.parse(source).body
    is_quiet = all(
        isinstance(one, quiet)
        or (isinstance(one, ast.Expr) and isinstance(one.value, ast.Constant))
        for one in statements
    )
    return is_quiet and any(
        isinstance(one, ast.FunctionDef) and one.name == "main" for one in statements
    )


def fail(problem: str) -> NoReturn:
    """End with a line on standard error."""
    sys.stderr.write(f"aionode.rclpy: {problem}\n")
    raise SystemExit(2)


def report(
    kind: type[BaseException], error: BaseException, traceback: TracebackType | None
) -> None:
    """Print an exception that the program did not catch, without the lines of what runs it.

    Below a missing module of ROS stands what to do about it.
    """
    own = [entry for entry in entries(traceback) if entry.tb_frame.f_globals is globals()]
    if own:
        error = error.with_traceback(own[-1].tb_next)
    sys.__excepthook__(kind, error, error.__traceback__)
    if isinstance(error, Exception):
        advise(error)


def advise(error: Exception) -> None:
    """Print what to do about the modules of ROS that an exception did not find."""
    from aionode.rclpy._finder import ALIASES
    from aionode.rclpy._missing import advice, missing_modules
    from aionode.rclpy._rosidl import has_interfaces

    for module in missing_modules(error):
        text = advice(module, frozenset(ALIASES))
        if text is not None and not has_interfaces(module.partition(".")[0]):
            sys.stderr.write(f"aionode.rclpy: {text}\n")


def entries(traceback: TracebackType | None) -> Iterator[TracebackType]:
    """Yield the entries of a traceback, the outermost call first."""
    while traceback is not None:
        yield traceback
        traceback = traceback.tb_next
