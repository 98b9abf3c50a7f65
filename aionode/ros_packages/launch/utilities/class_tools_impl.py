"""`launch.utilities.class_tools_impl`: checks of objects and classes."""

from __future__ import annotations

import inspect
from typing import Any

__all__ = ["is_a", "is_a_subclass", "isclassinstance"]


def is_a(obj: Any, entity_type: type) -> bool:
    """Return whether an object is of a type."""
    return isinstance(obj, entity_type)


def is_a_subclass(obj: Any, entity_type: type) -> bool:
    """Return whether an object, or a class, is of a type."""
    return isinstance(obj, entity_type) or (isinstance(obj, type) and issubclass(obj, entity_type))


def isclassinstance(obj: object) -> bool:
    """Return whether an object is an instance of a class, and not a module, class or function."""
    return not (inspect.ismodule(obj) or inspect.isclass(obj) or inspect.isroutine(obj))
