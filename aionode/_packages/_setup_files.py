"""Reads what a package can start from its setup files, and runs nothing of them."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any, Final

__all__ = ["entry_points", "scripts"]

INSTALL: Final = re.compile(
    r"\binstall\s*\(\s*(PROGRAMS|FILES)\s+(?P<files>[^()]*?)\s+"
    r"DESTINATION\s+\"?lib/(?P<package>[^\s\"/)]+)/?\"?(?:\s+RENAME\s+(?P<name>[^\s)]+))?",
    re.IGNORECASE,
)
"""``install(PROGRAMS scripts/mover.py DESTINATION lib/${PROJECT_NAME})`` in a CMakeLists.txt."""


def entry_points(folder: Path) -> dict[str, str]:
    """Return the functions that a package starts, as ``module:function``, by their names.

    They stand in its setup.py, setup.cfg or pyproject.toml. What a setup.py computes by more than
    constants, names, f-strings and sums is not known.
    """
    scripts: dict[str, str] = {}
    for source in (of_pyproject(folder), of_setup_cfg(folder), of_setup_py(folder)):
        scripts.update(source)
    return scripts


def of_pyproject(folder: Path) -> dict[str, str]:
    """Return the scripts of a pyproject.toml."""
    import tomllib  # few packages of ROS have such a file

    try:
        content = tomllib.loads((folder / "pyproject.toml").read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return {}
    project = content.get("project")
    named = project.get("scripts") if isinstance(project, dict) else None
    pairs = named.items() if isinstance(named, dict) else ()
    return {name: target for name, target in pairs if isinstance(target, str)}


def of_setup_cfg(folder: Path) -> dict[str, str]:
    """Return the console scripts of a setup.cfg."""
    import configparser  # not for those who start nothing by its package

    parser = configparser.ConfigParser(interpolation=None)
    try:
        parser.read(folder / "setup.cfg", encoding="utf-8")
    except (configparser.Error, ValueError):
        return {}
    section = "options.entry_points"
    return dict(of_lines(parser.get(section, "console_scripts", fallback="").splitlines()))


def of_setup_py(folder: Path) -> dict[str, str]:
    """Return the console scripts of a setup.py."""
    given = arguments(folder).get("entry_points")
    if isinstance(given, str):  # the same as in a setup.cfg
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
    """Return the files that a package starts, by their names.

    They are the ``scripts`` of a setup.py, its ``data_files`` for ``lib/PACKAGE``, and what a
    CMakeLists.txt installs as programs.
    """
    given = arguments(folder)
    files = [item for item in listed(given.get("scripts")) if isinstance(item, str)]
    for pair in listed(given.get("data_files")):
        if len(listed(pair)) == 2 and pair[0] == f"lib/{package}":
            files += [item for item in listed(pair[1]) if isinstance(item, str)]
    executables = {Path(file).name: folder / file for file in files}
    executables.update(of_cmake(folder, package))
    return {name: file for name, file in executables.items() if file.is_file()}


def listed(value: Any) -> list[Any]:
    """Return a list for a list or tuple, and an empty one for anything else."""
    return list(value) if isinstance(value, list | tuple) else []


def of_cmake(folder: Path, package: str) -> Iterator[tuple[str, Path]]:
    """Yield the name and the file of each program that a CMakeLists.txt installs."""
    try:
        text = (folder / "CMakeLists.txt").read_text(encoding="utf-8", errors="replace")
    except OSError:
        return
    text = re.sub(r"#[^\n]*", "", text).replace("${PROJECT_NAME}", package)
    for match in INSTALL.finditer(text):
        files = match["files"].replace('"', "").split()
        if match["package"] == package:
            yield from (
                ((match["name"] or "").strip('"') or Path(file).name, folder / file)
                for file in files
            )


def arguments(folder: Path) -> dict[str, Any]:
    """Return the arguments of the call of ``setup`` in a setup.py, as far as they are known."""
    try:
        tree = ast.parse((folder / "setup.py").read_bytes())
    except (OSError, SyntaxError, ValueError):
        return {}
    names: dict[str, Any] = {}
    for statement in tree.body:
        match statement:
            case ast.Assign(targets=[ast.Name(id=name)], value=value):
                names[name] = value_of(value, names)
    for node in ast.walk(tree):
        if isinstance(node, ast.Call) and ast.unparse(node.func).rpartition(".")[2] == "setup":
            return {word.arg: value_of(word.value, names) for word in node.keywords if word.arg}
    return {}


def value_of(node: ast.expr, names: dict[str, Any]) -> Any:
    """Return the value of an expression of constants and known names; None for any other one."""
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
        case ast.Call(func=function, args=parts) if ast.unparse(function) == "os.path.join":
            return joined([value_of(part, names) for part in parts], "/")
        case _:
            return None


def joined(parts: list[Any], between: str) -> str | None:
    """Return texts as one; None if one of them is not known."""
    return between.join(parts) if all(isinstance(part, str) for part in parts) else None


def added(left: Any, right: Any) -> Any:
    """Return the sum of two texts or two lists; None if they are not known."""
    if isinstance(left, str) and isinstance(right, str):
        return left + right
    return left + right if isinstance(left, list) and isinstance(right, list) else None
