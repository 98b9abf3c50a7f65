"""Prints the names that classes of ROS's Python packages have, a class in each line of JSON.

``class_names.jsonl`` is what it prints for the folders of rclpy 9.1.2 and, as of their branches
``rolling`` in December 2024, of tf2_ros, tf2_py, message_filters, launch and launch_ros::

    python list_class_names.py …/rclpy …/tf2_ros …/tf2_py …/message_filters …/launch …/launch_ros

Sources are read and nothing is imported. Of each class there are its bases, and the names that its
body defines or its methods give to ``self``, without those that Python mangles.
"""

from __future__ import annotations

import ast
import json
import re
import sys
from collections.abc import Iterator
from pathlib import Path

METHOD_IN_C = re.compile(r'^\s*\{"(\w+)", [^"]', re.MULTILINE)
"""A line of the method table of a type written in C."""


def names_of(node: ast.ClassDef) -> Iterator[str]:
    """Yield the names that the body of a class defines, or its methods give to ``self``."""
    attributes = (part for part in ast.walk(node) if isinstance(part, ast.Attribute))
    for attribute in attributes:
        if isinstance(attribute.ctx, ast.Store) and ast.unparse(attribute.value) == "self":
            yield attribute.attr
    for part in node.body:
        if isinstance(part, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
            names = [part.name]
        else:
            words = (word for word in ast.walk(part) if isinstance(word, ast.Name))
            names = [word.id for word in words if isinstance(word.ctx, ast.Store)]
        yield from names


def base_of(expression: ast.expr) -> str:
    """Return the name of a base class, without its module and its parameters."""
    return ast.unparse(expression).partition("[")[0].rpartition(".")[2]


def classes_in(folder: Path) -> dict[str, dict[str, list[str]]]:
    """Return bases and names of the classes in a folder, by their names."""
    classes: dict[str, dict[str, list[str]]] = {}
    for path in sorted(folder.rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.ClassDef):
                entry = classes.setdefault(node.name, {"bases": [], "names": []})
                entry["bases"] = sorted({*entry["bases"], *map(base_of, node.bases)})
                own = {name for name in names_of(node) if not name.startswith("__")}
                entry["names"] = sorted({*entry["names"], *own})
    for path in sorted(folder.parent.rglob(f"{folder.name}.cpp")):
        methods = sorted(set(METHOD_IN_C.findall(path.read_text(encoding="utf-8"))))
        classes["BufferCore"] = {"bases": [], "names": methods}
    return classes


if __name__ == "__main__":
    for folder in map(Path, sys.argv[1:]):
        for name, entry in sorted(classes_in(folder).items()):
            print(json.dumps({"package": folder.name, "class": name, **entry}))
