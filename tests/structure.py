"""Private names that cross a top-level folder of aionode: ``python -m tests.structure``.

The first number that it prints is how many there are; a line for each follows. `_process`,
`_distribution` and `_packages` are open to all of aionode.
"""

from __future__ import annotations

import ast
import re
from pathlib import Path
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from collections.abc import Iterator

__all__ = ["crossings"]

ROOT: Final = Path(__file__).parents[1] / "aionode"
ROS_PACKAGES: Final = "ros_packages"
OPEN: Final = frozenset({"_process", "_distribution", "_packages"})

PRIVATE_NAME: Final = re.compile(r"[\s.,(]_[a-zA-Z]")


def crossings() -> list[str]:
    """Return ``importer: name`` for each private name that is imported from another room."""
    return sorted(
        f"{'.'.join(importer)}: {'.'.join(imported)}"
        for path in ROOT.rglob("*.py")
        if (importer := path.relative_to(ROOT).with_suffix("").parts)
        for imported in imported_by(path)
        if imported[0] not in {importer[0], *OPEN} and any(map(is_private, imported))
    )


def is_private(name: str) -> bool:
    """Return whether a name begins with one underscore."""
    return name.startswith("_") and not name.startswith("__")


def imported_by(path: Path) -> Iterator[tuple[str, ...]]:
    """Yield each name of aionode that a module imports: its room, what is within, and the name.

    None if it has no private name at all. ROS's packages have their own names, and are one room.
    """
    text = path.read_text(encoding="utf-8")
    if not PRIVATE_NAME.search(text):  # as in the generated modules, which are half of all lines
        return
    for node in ast.walk(ast.parse(text)):
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


if __name__ == "__main__":
    found = crossings()
    print(len(found), *found, sep="\n")  # noqa: T201  # a program prints
