"""`launch.descriptions`."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from launch.substitution import (
    SomeSubstitutionsType,
    Substitution,
    normalize_to_list_of_substitutions,
)

__all__ = ["Executable"]


def substitutions_of(value: SomeSubstitutionsType | None) -> list[Substitution] | None:
    """Return the substitutions that make up a text, if there is one."""
    return None if value is None else normalize_to_list_of_substitutions(value)


class Executable:
    """A program, its arguments and its environment."""

    def __init__(
        self,
        *,
        cmd: Iterable[SomeSubstitutionsType],
        prefix: SomeSubstitutionsType | None = None,
        name: SomeSubstitutionsType | None = None,
        cwd: SomeSubstitutionsType | None = None,
        env: Mapping[Any, Any] | None = None,
        additional_env: Mapping[Any, Any] | None = None,
        arguments: Iterable[SomeSubstitutionsType] | None = None,
    ) -> None:
        words = [*cmd, *(arguments or ())]
        self.cmd = [normalize_to_list_of_substitutions(word) for word in words]
        self.prefix = substitutions_of(prefix)
        self.name = substitutions_of(name)
        self.cwd = substitutions_of(cwd)
        self.env = env
        self.additional_env = additional_env
