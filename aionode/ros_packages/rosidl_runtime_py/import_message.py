"""Classes for the types of fields."""

from __future__ import annotations

import warnings
from importlib import import_module
from typing import Any

from rosidl_parser.definition import NamespacedType

__all__ = ["import_message_from_namespaced_type"]


def import_message_from_namespaced_type(message_type: Any) -> Any:
    """Return the class of a type; for a sequence, of its elements, with a warning.

    Raises:
        ModuleNotFoundError: There is no such package.
        AttributeError: There is no such type in it.
    """
    if not isinstance(message_type, NamespacedType) and hasattr(message_type, "value_type"):
        message_type = message_type.value_type
        warnings.warn(
            "Passing objects containing a NamespacedType is deprecated, "
            "please pass a NamespacedType object directly",
            DeprecationWarning,
            stacklevel=2,
        )
    return getattr(import_module(".".join(message_type.namespaces)), message_type.name)
