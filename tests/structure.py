"""Private names that cross a top-level folder of aionode: ``python -m tests.structure``.

The first number that it prints is how many there are; a line for each follows: imports, and reads
of another object's attributes. `_process`, `_distribution`, `_packages` and `_version` are open to
all of aionode. What a subclass reads of itself does not count: that is between it and its base.
"""

from __future__ import annotations

import ast
import re
from collections import defaultdict
from pathlib import Path
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

__all__ = ["crossings", "imports", "reads"]

ROOT: Final = Path(__file__).parents[1] / "aionode"
ROS_PACKAGES: Final = "ros_packages"
OPEN: Final = frozenset({"_process", "_distribution", "_packages", "_version"})

GIVEN: Final = {
    "_make": "namedtuple's",
    "_CREATE_ROS_MESSAGE": "of the classes that ROS generates, which its rclpy reads too",
    "_DESTROY_ROS_MESSAGE": "the same",
    "_TYPE_SUPPORT": "the same",
    "_allFramesAsDot": "of tf2's Buffer, which programs call",
    "_chain": "the same",
    "_getFrameStrings": "the same",
    "_set_ros_time_is_active": "of rclpy's clock",
}
"""Names with an underscore that others have given to a public method or attribute, and whose."""

PRIVATE_NAME: Final = re.compile(r"[\s.,(\"']_[a-zA-Z]")


def crossings() -> list[str]:
    """Return each private name that is imported or read from another room."""
    trees = dict(parsed())
    return [*imports(trees), *reads(trees)]


def parsed() -> Iterator[tuple[Path, ast.Module]]:
    """Yield the tree of each module that has a private name, by its path below aionode.

    The generated modules, which are half of all lines, have none.
    """
    for path in sorted(ROOT.rglob("*.py")):
        text = path.read_text(encoding="utf-8")
        if PRIVATE_NAME.search(text):
            yield path.relative_to(ROOT), ast.parse(text)


def is_private(name: str) -> bool:
    """Return whether a name begins with one underscore."""
    return name.startswith("_") and not name.startswith("__")


# Imports


def imports(trees: Mapping[Path, ast.Module]) -> list[str]:
    """Return ``importer: name`` for each private name that is imported from another room."""
    return sorted(
        f"{'.'.join(importer)}: {'.'.join(imported)}"
        for path, tree in trees.items()
        if (importer := path.with_suffix("").parts)
        for imported in imported_by(tree)
        if imported[0] not in {importer[0], *OPEN} and any(map(is_private, imported))
    )


def imported_by(tree: ast.Module) -> Iterator[tuple[str, ...]]:
    """Yield each name of aionode that a module imports: its room, what is within, and the name.

    ROS's packages have their own names, and are one room.
    """
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom):
            names = [f"{node.module}.{alias.name}" for alias in node.names]
        elif isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        else:
            continue
        for name in names:
            package, *inside = name.split(".")
            if package == "aionode" and inside:
                yield tuple(inside)
            elif (ROOT / ROS_PACKAGES / package).exists():
                yield (ROS_PACKAGES, package, *inside)


# Attributes


def reads(trees: Mapping[Path, ast.Module]) -> list[str]:
    """Return ``path:line: expression`` for each private attribute of another room's object.

    The type of an object is not known here, so this is what a room reads that it never sets or
    defines, while another one does.
    """
    rooms: dict[str, set[str]] = defaultdict(set)  # which define each name
    for path, tree in trees.items():
        for name in defined_by(tree):
            rooms[name].add(path.parts[0])
    return [
        f"{path.as_posix()}:{node.lineno}: {ast.unparse(node)}"
        for path, tree in trees.items()
        for node in ast.walk(tree)
        if isinstance(node, ast.Attribute)
        and is_private(node.attr)
        and node.attr not in GIVEN
        and not is_own(node.value)
        and rooms[node.attr]
        and rooms[node.attr].isdisjoint({path.parts[0], *OPEN})
    ]


def is_own(holder: ast.expr) -> bool:
    """Return whether an attribute is read of the object itself, its class or its base."""
    return ast.unparse(holder) in {"self", "cls", "super()"}


def defined_by(tree: ast.Module) -> Iterator[str]:
    """Yield the private names that a module defines, sets, or has as a text, as in `__slots__`."""
    for node in ast.walk(tree):
        match node:
            case ast.FunctionDef(name=name) | ast.AsyncFunctionDef(name=name):
                pass
            case ast.Attribute(attr=name, ctx=ast.Store(), value=holder) if is_own(holder):
                pass
            case ast.Name(id=name, ctx=ast.Store()) | ast.Constant(value=str(name)):
                pass
            case _:
                continue
        if is_private(name):
            yield name


if __name__ == "__main__":
    found = crossings()
    print(len(found), *found, sep="\n")  # noqa: T201  # a program prints
