"""Prints the public names of rclpy's modules and classes, as JSON, for any rclpy.

``names.json`` is its output with rclpy 9.1.2. It omits the names of `typing` and of the rest of
Python, which say nothing about rclpy, and what classes have from outside rclpy.
"""

from __future__ import annotations

import importlib
import inspect
import json
import pkgutil
import sys
import typing
import warnings
from collections.abc import Iterable, Iterator
from typing import Any

import rclpy

OF_TYPING = {*dir(typing), "annotations", "T", "TypeAlias", "deprecated"}


def public(names: Iterable[str]) -> list[str]:
    """Return names without an underscore, in order."""
    return sorted(name for name in names if not name.startswith("_"))


def modules() -> Iterator[str]:
    """Yield the names of the public modules."""
    yield "rclpy"
    for found in pkgutil.walk_packages(rclpy.__path__, "rclpy."):
        if not any(part.startswith("_") for part in found.name.split(".")):
            yield found.name


def is_of_python(found: Any) -> bool:
    """Return whether a module, class or function is not of ROS."""
    if not (inspect.ismodule(found) or inspect.isclass(found) or inspect.isroutine(found)):
        return False
    home = found.__name__ if inspect.ismodule(found) else found.__module__ or "builtins"
    return home.partition(".")[0] in {*sys.stdlib_module_names, "yaml"}


warnings.simplefilter("ignore")
names, classes = {}, {}
for name in modules():
    module = importlib.import_module(name)
    names[name] = [
        each
        for each in public(vars(module))
        if each not in OF_TYPING and not is_of_python(vars(module)[each])
    ]
    for each in names[name]:
        found = vars(module)[each]
        if inspect.isclass(found) and found.__module__ == name:
            inside = {part for base in found.__mro__[:-1] for part in vars(base)}
            classes[f"{name}.{each}"] = public(inside - {*dir(Exception), "name", "value"})
print(json.dumps({"modules": names, "classes": classes}, indent=1))
