"""Reads from the setup files of a package what it installs, without running them."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from functools import cache, partial
from pathlib import Path
from stat import S_ISREG
from typing import Any, Final

from aionode._packages._cmake import Install, installs_of, matching

__all__ = [
    "SETUP_FILES",
    "data_files",
    "entry_points",
    "import_folders",
    "parameter_calls",
    "scripts",
]

SETUP_FILES: Final = frozenset({"pyproject.toml", "setup.cfg", "setup.py"})
"""The files that describe a Python project."""

MAX_BYTES: Final = 200_000
"""Maximum size of a file that is read, as a workspace may contain anything; they have some kB."""

MAX_TEXT: Final = 100_000
"""Maximum length of texts and lists computed from a setup.py, since sums may grow without bound."""


def entry_points(folder: Path) -> dict[str, str]:
    """Return the entry points of a package, as ``module:function``, by name.

    They are declared in its setup.py, setup.cfg or pyproject.toml. Of a setup.py only constants,
    names, f-strings and sums are evaluated.
    """
    scripts: dict[str, str] = {}
    for source in (of_pyproject(folder), of_setup_cfg(folder), of_setup_py(folder)):
        scripts.update(source)
    return scripts


def of_pyproject(folder: Path) -> dict[str, str]:
    """Return the scripts of a pyproject.toml."""
    pairs = table(pyproject(folder), "project", "scripts").items()
    return {name: target for name, target in pairs if isinstance(target, str)}


def pyproject(folder: Path) -> dict[str, Any]:
    """Return the content of a pyproject.toml; empty if there is none, or none that is readable."""
    import tomllib  # few ROS packages have such a file

    try:
        return tomllib.loads(content_of(folder / "pyproject.toml").decode())
    except (OSError, ValueError, RecursionError):
        return {}


def content_of(file: Path) -> bytes:
    """Return the content of a file; empty if it is not a regular one, or too large.

    Raises:
        OSError: It cannot be read.
    """
    status = file.stat()
    return file.read_bytes() if S_ISREG(status.st_mode) and status.st_size <= MAX_BYTES else b""


def table(content: Any, *keys: str) -> dict[str, Any]:
    """Return a table within others; empty if it is not there."""
    for key in keys:
        content = content.get(key) if isinstance(content, dict) else None
    return content if isinstance(content, dict) else {}


@cache
def import_folders(project: Path) -> tuple[Path, ...]:
    """Return the folders from which a project's modules are imported, as by ``pip install -e``.

    Those are the folders that it names to setuptools or Poetry, or else its own and its ``src``.
    Without any, the project cannot be installed: its files have only the settings of tools, or say
    so.
    """
    described = pyproject(project)
    tools = table(described, "tool")
    is_installed = (
        not {"project", "build-system"}.isdisjoint(described)
        or "poetry" in tools
        or bool(section(project, "metadata") or section(project, "options"))
        or bool(calls_of(project, "setup"))
    )
    if (
        not is_installed
        or table(tools, "uv").get("package") is False
        or table(tools, "poetry").get("package-mode") is False
    ):
        return ()
    named = [name for name in named_folders(project, tools) if isinstance(name, str)]
    return tuple(dict.fromkeys(project / name for name in named or (".", "src")))


def named_folders(project: Path, tools: dict[str, Any]) -> Iterator[Any]:
    """Yield the folders that contain a project's packages, as its setup files name them."""
    for each in listed(table(tools, "poetry").get("packages")):
        yield table(each).get("from", ".")
    yield from listed(table(tools, "setuptools", "packages", "find").get("where"))
    yield dict(section(project, "options.packages.find")).get("where")
    places = of_lines(dict(section(project, "options")).get("package_dir", "").splitlines())
    given = table(arguments(project), "package_dir")
    for name, place in (
        *table(tools, "setuptools", "package-dir").items(),
        *places,
        *given.items(),
    ):
        if not name:
            yield place
        elif isinstance(place, str) and Path(place).name == name:
            yield str(Path(place).parent)


def of_setup_cfg(folder: Path) -> dict[str, str]:
    """Return the console scripts of a setup.cfg."""
    lines = dict(section(folder, "options.entry_points")).get("console_scripts", "")
    return dict(of_lines(lines.splitlines()))


def section(folder: Path, name: str) -> list[tuple[str, str]]:
    """Return the options of a section of a setup.cfg, with their values."""
    import configparser  # not needed by most programs

    parser = configparser.ConfigParser(interpolation=None)
    parser.optionxform = str  # type: ignore[assignment,method-assign]  # option names are case-sensitive
    try:
        parser.read_string(content_of(folder / "setup.cfg").decode())
        return parser.items(name)
    except (OSError, configparser.Error, ValueError):
        return []


def of_setup_py(folder: Path) -> dict[str, str]:
    """Return the console scripts of a setup.py."""
    given = arguments(folder).get("entry_points")
    if isinstance(given, str):  # same format as in a setup.cfg
        import configparser

        parser = configparser.ConfigParser(interpolation=None)
        try:
            parser.read_string(given)
        except configparser.Error:
            return {}
        given = {name: dict(parser.items(name)) for name in parser.sections()}
    listed = given.get("console_scripts") if isinstance(given, dict) else None
    if isinstance(listed, dict):
        return {name: target for name, target in listed.items() if isinstance(target, str)}
    lines = listed.splitlines() if isinstance(listed, str) else listed or ()
    return dict(of_lines(line for line in lines if isinstance(line, str)))


def of_lines(lines: Any) -> Iterator[tuple[str, str]]:
    """Yield the name and the function of each line such as ``mover = robot.mover:main``."""
    for line in lines:
        name, equals, target = line.partition("=")
        if equals:
            yield name.strip(), target.partition("[")[0].strip()


def scripts(folder: Path, package: str) -> dict[str, Path]:
    """Return the files that a package installs as executables, by name.

    They are the ``scripts`` of a setup.py, its ``data_files`` for ``lib/PACKAGE``, and the programs
    that a CMakeLists.txt installs.
    """
    files = [item for item in listed(arguments(folder).get("scripts")) if isinstance(item, str)]
    executables = {Path(file).name: folder / file for file in files}
    programs = [rule for rule in installs_of(folder, package) if rule.is_program]
    for rule in [*data_files(folder), *programs]:
        if rule.folder.rstrip("/") == f"lib/{package}":
            executables[rule.name] = rule.source
    return {name: file for name, file in executables.items() if file.is_file()}


def data_files(folder: Path) -> Iterator[Install]:
    """Yield the ``data_files`` of a setup.cfg and a setup.py: each file and its destination."""
    pairs = [(into, lines.split()) for into, lines in section(folder, "options.data_files")]
    for pair in (*pairs, *listed(arguments(folder).get("data_files"))):
        if len(listed(pair)) != 2 or not isinstance(pair[0], str):
            continue
        for file in listed(pair[1]):
            names = matching(folder, file) if isinstance(file, str) and "*" in file else [file]
            for name in names:
                if isinstance(name, str):
                    yield Install(folder / name, pair[0], Path(name).name)


def listed(value: Any) -> list[Any]:
    """Return a list for a list or tuple, and an empty one for anything else."""
    return list(value) if isinstance(value, list | tuple) else []


def arguments(folder: Path) -> dict[str, Any]:
    """Return the arguments of the ``setup`` call in a setup.py, as far as they can be evaluated."""
    return next(iter(calls_of(folder, "setup")), {})


def parameter_calls(folder: Path) -> list[list[Any]]:
    """Return module, file and validators of each ``generate_parameter_module`` of a setup.py."""
    names = ("module_name", "yaml_file", "validation_module")
    return [
        [call.get(name) or call.get(str(index)) for index, name in enumerate(names)]
        for call in calls_of(folder, "generate_parameter_module")
    ]


def calls_of(folder: Path, function: str) -> list[dict[str, Any]]:
    """Return the arguments of each call of a function in a setup.py, by name or index.

    They are evaluated as far as they can be.
    """
    try:
        tree = ast.parse(content_of(folder / "setup.py"))
        return evaluated(tree, known_functions(folder), function)
    except (OSError, SyntaxError, ValueError, RecursionError, MemoryError):
        return []


def evaluated(tree: ast.Module, names: dict[str, Any], function: str) -> list[dict[str, Any]]:
    """Return the arguments of each call of a function; `names` are those known at the start."""
    for statement in statements(tree.body):
        match statement:
            case ast.Assign(targets=[ast.Name(id=name)], value=value):
                names[name] = value_of(value, names)
            case ast.AugAssign(target=ast.Name(id=name), op=ast.Add(), value=value):
                names[name] = added(names.get(name), value_of(value, names))
            case ast.Expr(
                ast.Call(
                    func=ast.Attribute(value=ast.Name(id=name), attr="append" | "extend" as how),
                    args=[value],
                )
            ):
                more = value_of(value, names)
                names[name] = added(names.get(name), [more] if how == "append" else more)
    return [
        {str(index): value_of(part, names) for index, part in enumerate(node.args)}
        | {word.arg: value_of(word.value, names) for word in node.keywords if word.arg}
        for node in ast.walk(tree)
        if isinstance(node, ast.Call) and ast.unparse(node.func).rpartition(".")[2] == function
    ]


def statements(body: list[ast.stmt]) -> Iterator[ast.stmt]:
    """Yield statements, and those within an ``if``."""
    for statement in body:
        yield statement
        if isinstance(statement, ast.If):
            yield from statements(statement.body)


def value_of(node: ast.expr, names: dict[str, Any]) -> Any:
    """Evaluate an expression of constants and known names; None for any other."""
    match node:
        case ast.Constant(value=value):
            return value
        case ast.Name(id=name):
            return names.get(name)
        case ast.List(elts=parts) | ast.Tuple(elts=parts):
            return [value_of(part, names) for part in parts]
        case ast.Dict():
            pairs = zip(node.keys, node.values, strict=True)
            return {value_of(key, names): value_of(value, names) for key, value in pairs if key}
        case ast.JoinedStr(values=parts):
            return joined([value_of(part, names) for part in parts], "")
        case ast.FormattedValue(value=inner, conversion=-1, format_spec=None):
            return value_of(inner, names)
        case ast.BinOp(left=left, op=ast.Add(), right=right):
            return added(value_of(left, names), value_of(right, names))
        case ast.ListComp(
            elt=part,
            generators=[ast.comprehension(target=ast.Name(id=name), iter=among, ifs=[])],
        ):
            values = listed(value_of(among, names))[:MAX_TEXT]
            return [value_of(part, names | {name: value}) for value in values]
        case ast.Call(keywords=[]):
            return result_of(node, names)
        case _:
            return None


def result_of(call: ast.Call, names: dict[str, Any]) -> Any:
    """Evaluate a call of a known function or of ``format``; None for any other."""
    values = [value_of(part, names) for part in call.args]
    if isinstance(call.func, ast.Attribute) and call.func.attr == "format":
        return formatted(value_of(call.func.value, names), values)
    function = names.get(ast.unparse(call.func))
    if callable(function) and values and all(isinstance(value, str) for value in values):
        return function(*values)
    return None


def known_functions(folder: Path) -> dict[str, Any]:
    """Return the functions that a setup.py may call, by their names there."""

    def join(*parts: str) -> str | None:
        return joined(list(parts), "/")

    return {
        **dict.fromkeys(("os.path.join", "path.join", "join", "osp.join"), join),
        **dict.fromkeys(("glob", "glob.glob"), partial(matching, folder)),
        **dict.fromkeys(("str", "os.path.normpath"), join),
    }


def formatted(text: Any, parts: list[Any]) -> str | None:
    """Return a text with its ``{}`` replaced in turn; None if something is unknown."""
    pieces = text.split("{}") if isinstance(text, str) else []
    if len(pieces) != len(parts) + 1:
        return None
    return joined([piece for pair in zip(pieces, [*parts, ""], strict=True) for piece in pair], "")


def joined(parts: list[Any], between: str) -> str | None:
    """Join texts; None if one of them is unknown or the result is too long."""
    if not all(isinstance(part, str) for part in parts) or sum(map(len, parts)) > MAX_TEXT:
        return None
    return between.join(parts)


def added(left: Any, right: Any) -> Any:
    """Return the sum of two texts, or of two lists as far as known; None for others."""
    if isinstance(left, str) and isinstance(right, str):
        return joined([left, right], "")
    if isinstance(left, list) or isinstance(right, list):
        return (listed(left) + listed(right))[:MAX_TEXT]
    return None
