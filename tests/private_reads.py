"""How often the tests read private names of aionode, by file: ``python -m tests.private_reads``.

A name counts where a test takes it from another object than its own, or replaces it: what pins such
a name breaks with each change inside, and passes when what the public name does is broken.
"""

from __future__ import annotations

import argparse
import ast
import re
import sys
from collections import Counter
from pathlib import Path
from typing import TYPE_CHECKING, Final

if TYPE_CHECKING:
    from collections.abc import Iterable

ROOT: Final = Path(__file__).parents[1]


def is_private(name: str) -> bool:
    """Return whether a name is private, and none that others have given."""
    return name.startswith("_") and not name.startswith("__") and name not in OTHERS


OTHERS: Final = frozenset(
    {
        "_AXES2TUPLE",  # tf_transformations
        "_LoadComposableNodes__composable_node_descriptions",  # launch_ros
        "_LoadComposableNodes__target_container",
        "_Service__service",  # rclpy
        "_TYPE_SUPPORT",  # the classes that ROS generates
        "_allFramesAsDot",  # tf2
        "_chain",
        "_check_fields",
        "_frameExists",
        "_getFrameStrings",
        "_replace",  # named tuples
        "_set_ros_time_is_active",  # rclpy
    }
)
"""Names with an underscore that programs use, because others have named them so."""

MODULES: Final = frozenset({"asyncio", "os", "sys"})
"""Modules of Python whose private names are none of aionode's."""


def names_in_aionode() -> set[str]:
    """Return the private names that stand in aionode."""
    texts = (path.read_text(encoding="utf-8") for path in (ROOT / "aionode").rglob("*.py"))
    return {name for text in texts for name in re.findall(r"\b_[A-Za-z]\w*", text)}


def reads_in(tree: ast.Module) -> Iterable[str]:
    """Yield each private name that a module takes from another object, or has replaced."""
    for node in ast.walk(tree):
        match node:
            case ast.Attribute(value=ast.Name(id=owner)) if owner in {"self", "cls", *MODULES}:
                pass
            case ast.Attribute(value=ast.Call(func=ast.Name(id="super"))):
                pass
            case ast.Attribute() if is_private(node.attr):
                yield node.attr
            case ast.Call(
                func=ast.Attribute(attr="setattr"),
                args=[_, ast.Constant(value=str(name)), _],
            ) if is_private(name):
                yield name


def count() -> dict[Path, Counter[str]]:
    """Return how often each file of the tests reads which private names, if it reads any."""
    own = names_in_aionode()
    counts = {}
    for path in sorted((ROOT / "tests").rglob("*.py")):
        text = path.read_text(encoding="utf-8")
        if re.search(r"[.\"']_[A-Za-z]", text):
            names = Counter(name for name in reads_in(ast.parse(text)) if name in own)
            if names:
                counts[path.relative_to(ROOT)] = names
    return counts


def main() -> None:
    """Print the files with most of them first, and the sum."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--names", action="store_true", help="say which names, too")
    with_names = parser.parse_args().names
    counts = count()
    lines = [
        " ".join((f"{names.total():5} {path}", *(sorted(names) if with_names else ())))
        for path, names in sorted(counts.items(), key=lambda item: -item[1].total())
    ]
    reads = sum(names.total() for names in counts.values())
    sys.stdout.write("\n".join((*lines, f"{reads:5} in {len(lines)} files\n")))


if __name__ == "__main__":
    main()
