"""`launch.utilities`: the functions that launch files and their helpers use."""

from __future__ import annotations

from typing import Any

from launch.event_handler import entities_of
from launch.substitution import (
    normalize_to_list_of_substitutions,
    perform_substitutions,
)
from launch.utilities.class_tools_impl import is_a, is_a_subclass, isclassinstance
from launch.utilities.type_utils import (
    normalize_typed_substitution,
    perform_typed_substitution,
)

__all__ = [
    "ensure_argument_type",
    "is_a",
    "is_a_subclass",
    "isclassinstance",
    "normalize_to_list_of_entities",
    "normalize_to_list_of_substitutions",
    "normalize_typed_substitution",
    "perform_substitutions",
    "perform_typed_substitution",
]


def normalize_to_list_of_entities(entities: Any) -> list[Any]:
    """Return entities as a list."""
    return entities_of(entities)


def ensure_argument_type(
    argument: object, types: Any, argument_name: str, caller: str | None = None
) -> None:
    """Raise TypeError if an argument has none of these types."""
    fitting = tuple(types) if isinstance(types, list | tuple) else (types,)
    if not isinstance(argument, fitting):
        where = f"{caller}: " if caller else ""
        names = ", ".join(kind.__name__ for kind in fitting)
        raise TypeError(f"{where}{argument_name} is {argument!r}; expected {names}")
