"""`moveit_configs_utils.substitutions.xacro`: what xacro makes of a file."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from launch.launch_context import LaunchContext
from launch.substitution import (
    SomeSubstitutionsType,
    Substitution,
    normalize_to_list_of_substitutions,
    perform_substitutions,
    text_of,
)
from launch_param_builder import load_xacro

__all__ = ["Xacro"]


class Xacro(Substitution):
    """The XML that xacro makes of a file, with arguments that are known only at launch."""

    def __init__(
        self,
        file_path: SomeSubstitutionsType,
        *,
        mappings: Mapping[SomeSubstitutionsType, SomeSubstitutionsType] | None = None,
    ) -> None:
        self._file_path = normalize_to_list_of_substitutions(file_path)
        self._mappings = dict(mappings or {})

    @property
    def file_path(self) -> list[Substitution]:
        """The path of the file."""
        return self._file_path

    @property
    def mappings(self) -> dict[SomeSubstitutionsType, SomeSubstitutionsType]:
        """The arguments."""
        return self._mappings

    def perform(self, context: LaunchContext) -> str:
        """Return the XML."""
        path = Path(perform_substitutions(context, self._file_path))
        arguments = {
            text_of(context, name): text_of(context, value)
            for name, value in self._mappings.items()
        }
        return load_xacro(path, mappings=arguments)
