"""Node classes and functions named by ``module:name`` or ``file.py:name``."""

from __future__ import annotations

import importlib
import importlib.util
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Any

from aionode.engine.context import openings
from aionode.errors import CommandError
from aionode.interfaces import interface_names
from aionode.node import Node

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from types import ModuleType

__all__ = ["FITS", "makers_of", "module_in_file", "node_maker"]

FITS = "expected MODULE:CLASS, such as my_robot.nodes:Talker or talker.py:Talker"


def makers_of(specs: Sequence[str]) -> list[Callable[[], Any]]:
    """Return the factories of the named nodes; none if a file has run them itself.

    A file whose last line runs its nodes, without checking ``__main__``, does so when it is
    imported. They have ended by then, and are not started again.

    Raises:
        CommandError: A node does not exist, or a file that runs its nodes itself is not the only
            one.
    """
    makers = []
    for spec in specs:
        maker = maker_of(spec)
        if maker is not None:
            makers.append(maker)
        elif len(specs) > 1:
            raise CommandError(
                f"{spec}: it has run its nodes itself, so no others can run beside them; for nodes "
                "of several files in one process, let it run them only `if __name__ == "
                '"__main__":`'
            )
    return makers


def maker_of(spec: str) -> Callable[[], Any] | None:
    """Return the factory of the named node; None if its module has run its nodes itself.

    Raises:
        CommandError: There is no such node, or it imports something that is not installed; an rclpy
            program may do so under a name that its text does not show.
    """
    before = openings()
    try:
        module_of(spec.partition(":")[0], spec)
        return node_maker(spec) if openings() == before else None
    except ImportError as error:
        # A folder of definitions beside the file is imported as a namespace package.
        if isinstance(error, ModuleNotFoundError) or "(unknown location)" in str(error):
            raise CommandError(f"{spec}: it imports {missing(error, spec)}") from error
        raise


def missing(error: ImportError, spec: str) -> str:
    """Describe what a module did not find, and what to do about it."""
    name = error.name or ""
    if name.startswith("aionode.interfaces."):
        return f"something that does not exist: {error}"
    types = interface_names(name.partition(".")[0])
    if types:
        package, kind, cls = types[0].split("/")
        line = f"from aionode.interfaces.{package}.{kind} import {cls}"
        return f"{name}, whose types are for nodes of aionode: `{line}`"
    name += ", which is not installed"
    return f"{name}; run a program of ROS 2 with `aionode run --rclpy {spec}`"


def node_maker(spec: str) -> Callable[[], Any]:
    """Return the class or function named by ``module:name`` or ``file.py:name``.

    The name may be omitted if the module defines exactly one node class.

    Raises:
        CommandError: there is no such module, or it has no node class or function of that name.
    """
    source, _, name = spec.partition(":")
    module = module_of(source, spec)
    if not name:
        return only_node_class(module, spec)
    maker: Any = module
    for part in name.split("."):
        maker = getattr(maker, part, None)
    if not callable(maker) or (isinstance(maker, type) and not issubclass(maker, Node)):
        known = ", ".join(node_classes(module)) or "none"
        what = "nothing of that name" if maker is None else "neither a node class nor a function"
        raise CommandError(f"{spec}: {what} in {source}; its node classes: {known}")
    return maker  # type: ignore[no-any-return]  # checked to be callable above


def module_of(source: str, spec: str) -> ModuleType:
    """Import the module of this name, or in this file."""
    if not source:
        raise CommandError(f"{spec!r}: no module; {FITS}")
    if source.endswith(".py"):
        return module_in_file(Path(source), spec)
    try:
        return importlib.import_module(source)
    except ModuleNotFoundError as error:
        if error.name is None or not f"{source}.".startswith(f"{error.name}."):
            raise CommandError(
                f"{spec}: {source} needs {error.name}, which is not installed"
            ) from error
        where = f"here ({Path.cwd()}) or installed"
        raise CommandError(f"{spec}: no module {error.name} {where}; {FITS}") from error


def module_in_file(path: Path, spec: str) -> ModuleType:
    """Import the module in a file; like a program, it may import modules beside it."""
    if not path.is_file():
        raise CommandError(f"{spec}: no file {path} here ({Path.cwd()}); {FITS}")
    loaded = sys.modules.get(path.stem)
    if loaded is not None and loaded.__spec__ is not None:
        origin = loaded.__spec__.origin
        if origin is not None and Path(origin).resolve() == path.resolve():
            return loaded
    sys.path.insert(0, str(path.parent.resolve()))
    module_spec = importlib.util.spec_from_file_location(path.stem, path)
    assert module_spec is not None  # noqa: S101  # its name ends in .py
    assert module_spec.loader is not None  # noqa: S101  # as above
    module = importlib.util.module_from_spec(module_spec)
    sys.modules[path.stem] = module
    module_spec.loader.exec_module(module)
    return module


def node_classes(module: ModuleType) -> dict[str, type[Node]]:
    """Return the node classes that a module defines itself."""
    return {
        name: value
        for name, value in vars(module).items()
        if isinstance(value, type)
        and issubclass(value, Node)
        and value.__module__ == module.__name__
    }


def only_node_class(module: ModuleType, spec: str) -> type[Node]:
    """Return the only node class of a module."""
    known = node_classes(module)
    if len(known) != 1:
        raise CommandError(
            f"{spec}: give a class, as {spec}:NAME; its node classes: {', '.join(known) or 'none'}"
        )
    return next(iter(known.values()))
