"""How often the tests read private names of aionode, by file: ``python -m tests.private_reads``.

A name counts where a test takes it from another object than its own, or replaces it: what pins such
a name breaks with each change inside, and passes when what the public name does is broken.
"""

from __future__ import annotations

import argparse
import ast
import sys
from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

ROOT: Final = Path(__file__).parents[1]


def is_private(name: str) -> bool:
    """Return whether a name is private, and none of Python's own."""
    return name.startswith("_") and not name.startswith("__")


def trees(folder: str) -> Iterator[tuple[Path, ast.Module]]:
    """Yield each module of a folder."""
    for path in sorted((ROOT / folder).rglob("*.py")):
        yield path.relative_to(ROOT), ast.parse(path.read_text(encoding="utf-8"))


def names_of(tree: ast.Module) -> Iterable[str]:
    """Yield what a module defines and assigns."""
    for node in ast.walk(tree):
        match node:
            case ast.FunctionDef() | ast.AsyncFunctionDef() | ast.ClassDef():
                yield node.name
            case ast.Attribute():
                yield node.attr
            case ast.Name(ctx=ast.Store()):
                yield node.id


def reads_in(tree: ast.Module) -> Iterable[str]:
    """Yield each private name that a module takes from another object, or has replaced."""
    for node in ast.walk(tree):
        match node:
            case ast.Attribute(value=ast.Name(id="self" | "cls")):
                pass
            case ast.Attribute() if is_private(node.attr):
                yield node.attr
            case ast.Call(
                func=ast.Attribute(attr="setattr"),
                args=[_, ast.Constant(value=str(name)), _],
            ) if is_private(name):
                yield name


def main() -> None:
    """Print the files with most of them first, and the sum."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--names", action="store_true", help="say which names, too")
    with_names = parser.parse_args().names
    own = {name for _, tree in trees("aionode") for name in names_of(tree)}
    found = {
        path: Counter(name for name in reads_in(tree) if name in own)
        for path, tree in trees("tests")
    }
    lines = [
        " ".join((f"{names.total():5} {path}", *(sorted(names) if with_names else ())))
        for path, names in sorted(found.items(), key=lambda item: -item[1].total())
        if names
    ]
    reads = sum(names.total() for names in found.values())
    sys.stdout.write("\n".join((*lines, f"{reads:5} in {len(lines)} files\n")))


if __name__ == "__main__":
    main()
