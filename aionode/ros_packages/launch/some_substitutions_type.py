"""`launch.some_substitutions_type`."""

from __future__ import annotations

from collections.abc import Iterable

from launch.substitution import SomeSubstitutionsType, Substitution

__all__ = ["SomeSubstitutionsType", "SomeSubstitutionsType_types_tuple"]

SomeSubstitutionsType_types_tuple = (str, Substitution, Iterable)
