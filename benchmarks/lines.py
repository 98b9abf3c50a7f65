"""How much code each room of aionode has: lines by package, now and in an earlier commit.

Rooms are those of docs/design.md: a package or module of ``aionode/``, and each transport
separately, as well as the protocol of bridges to DDS within that of Zenoh, and each package of ROS.
Generated interfaces, tests and documentation are left out. Every line counts, so that denser lines
do not hide anything: the columns distinguish code, text (docstrings and comments), and lines that
only pass names on, which are each ``__all__`` and each module that consists of imports.

Run it with ``python benchmarks/lines.py``. ``--since COMMIT`` adds the lines of a commit and the
difference, ``--room ros_packages/rclpy`` lists the modules of one room.
"""

from __future__ import annotations

import argparse
import ast
import io
import subprocess
import tarfile
import tokenize
from collections import defaultdict
from dataclasses import dataclass, fields
from pathlib import Path
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

ROOT: Final = Path(__file__).parents[1]
DIVIDED: Final = ("engine", "ros_packages")
"""Packages whose parts are rooms of their own."""

INNER_ROOMS: Final = (
    "engine/transport/zenoh/bridge",
    "engine/transport/zenoh",
    "engine/transport/link",
    "engine/transport/rcl",
    "engine/transport/reliability",
)
"""Packages within others that are rooms of their own, the innermost first: one protocol each."""


@dataclass
class Count:
    """The numbers of lines in a module, or in all modules of a room.

    Attributes:
        modules: How many files.
        lines: All lines.
        code: Lines with code, names left out.
        text: Lines of docstrings and comments; a comment beside code is code.
        names: Lines that pass names on.
    """

    modules: int = 0
    lines: int = 0
    code: int = 0
    text: int = 0
    names: int = 0

    def __add__(self, other: Count) -> Count:
        return Count(
            *(getattr(self, each.name) + getattr(other, each.name) for each in fields(Count))
        )


def count(source: str) -> Count:
    """Return the counts of one module."""
    tree = ast.parse(source)
    code = code_lines(source)
    text = docstring_lines(tree) & code
    names = name_lines(tree) & (code - text)
    comments = sum(line.lstrip().startswith("#") for line in source.splitlines())
    return Count(
        modules=1,
        lines=len(source.splitlines()),
        code=len(code - text - names),
        text=len(docstring_lines(tree)) + comments,
        names=len(names),
    )


def code_lines(source: str) -> set[int]:
    """Return the numbers of the lines with anything but comments."""
    silent = {tokenize.COMMENT, tokenize.NL, tokenize.NEWLINE, tokenize.INDENT, tokenize.DEDENT}
    found: set[int] = set()
    for token in tokenize.generate_tokens(io.StringIO(source).readline):
        if token.type not in silent and token.type != tokenize.ENDMARKER:
            found.update(range(token.start[0], token.end[0] + 1))
    return found


def docstring_lines(tree: ast.Module) -> set[int]:
    """Return the numbers of the lines of docstrings, those of attributes included."""
    return {
        line
        for node in ast.walk(tree)
        if isinstance(node, ast.Expr)
        and isinstance(node.value, ast.Constant)
        and isinstance(node.value.value, str)
        for line in lines_of(node)
    }


def name_lines(tree: ast.Module) -> set[int]:
    """Return the numbers of the lines that pass names on."""
    statements = [node for node in tree.body if not isinstance(node, ast.Expr)]
    lists = [node for node in statements if is_list_of_names(node)]
    others = [node for node in statements if node not in lists]
    only_names = all(isinstance(node, ast.Import | ast.ImportFrom) for node in others)
    return {line for node in (statements if only_names else lists) for line in lines_of(node)}


def is_list_of_names(node: ast.stmt) -> bool:
    """Return whether a statement is the assignment of `__all__`."""
    return isinstance(node, ast.Assign) and any(
        isinstance(target, ast.Name) and target.id == "__all__" for target in node.targets
    )


def lines_of(node: ast.stmt) -> range:
    """Return the numbers of the lines of a statement."""
    return range(node.lineno, (node.end_lineno or node.lineno) + 1)


def modules_now() -> Iterator[tuple[str, str]]:
    """Yield path and source of each module of the working tree."""
    for path in sorted(ROOT.glob("aionode/**/*.py")):
        yield path.relative_to(ROOT).as_posix(), path.read_text(encoding="utf-8")


def modules_of(commit: str) -> Iterator[tuple[str, str]]:
    """Yield path and source of each module of a commit."""
    packed = subprocess.run(  # noqa: S603  # git, with a commit of this repository
        ["git", "archive", commit, "aionode"],  # noqa: S607  # the user's git
        cwd=ROOT,
        capture_output=True,
        check=True,
    ).stdout
    with tarfile.open(fileobj=io.BytesIO(packed)) as archive:
        for member in archive.getmembers():
            file = archive.extractfile(member) if member.name.endswith(".py") else None
            if file is not None:
                yield member.name, file.read().decode()


def is_generated(path: str) -> bool:
    """Return whether a module is generated from the standard definitions."""
    parts = path.split("/")
    return parts[1] == "interfaces" and len(parts) > 3


def room_of(path: str) -> str:
    """Return the room of a module."""
    parts = path.removesuffix(".py").split("/")[1:]
    for room in INNER_ROOMS:
        if "/".join(parts).startswith(f"{room}/"):
            return room
    if parts[0] in DIVIDED and len(parts) > 2:
        return "/".join(parts[:2])
    return parts[0]


def rooms(modules: Iterable[tuple[str, str]], only: str | None) -> dict[str, Count]:
    """Return the counts of each room; with `only`, of each module in that room."""
    found: dict[str, Count] = defaultdict(Count)
    for path, source in modules:
        room = room_of(path)
        if is_generated(path) or (only is not None and room != only):
            continue
        found[room if only is None else path] += count(source)
    return found


def show(now: dict[str, Count], before: dict[str, Count] | None) -> None:
    """Print a table, most lines first."""
    width = max(map(len, now), default=4)
    header = f"{'':{width}}  modules   lines    code    text   names"
    print(header if before is None else f"{header}  before  change")
    rows = sorted({*now, *(before or ())}, key=lambda name: (-now.get(name, Count()).lines, name))
    print(row("all", width, now.values(), None if before is None else before.values()))
    for name in rows:
        earlier = None if before is None else [before.get(name, Count())]
        print(row(name, width, [now.get(name, Count())], earlier))


def row(name: str, width: int, now: Iterable[Count], before: Iterable[Count] | None) -> str:
    """Return one row: the sums of several counts."""
    has = sum(now, Count())
    text = f"{name:{width}}  {has.modules:7}{has.lines:8}{has.code:8}{has.text:8}{has.names:8}"
    if before is None:
        return text
    had = sum(before, Count())
    return f"{text}{had.lines:8}{has.lines - had.lines:+8}"


def main() -> None:
    """Count and print."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n", maxsplit=1)[0])
    parser.add_argument("--since", metavar="COMMIT", help="a commit to compare with")
    parser.add_argument("--room", help="one room, module by module")
    arguments = parser.parse_args()
    before = rooms(modules_of(arguments.since), arguments.room) if arguments.since else None
    show(rooms(modules_now(), arguments.room), before)


if __name__ == "__main__":
    main()
