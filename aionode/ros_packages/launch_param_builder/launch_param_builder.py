"""`launch_param_builder.launch_param_builder`: collects parameters for a node."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, Self

from aionode._packages import package_of_stand_in
from launch.stand_in import StandIn
from launch_param_builder.utils import (
    ParameterValueType,
    get_path,
    load_file,
    load_xacro,
    load_yaml,
)

__all__ = ["ParameterBuilder"]


class ParameterBuilder:
    """Parameters from the files of a package, added one after another.

    A missing package has a stand-in if it may be missing: what is built from it is left out.
    """

    def __new__(cls, package_name: str, *_: Any, **__: Any) -> Any:
        """Return a builder, or its stand-in."""
        missing = package_of_stand_in(get_path(package_name, ""))
        return super().__new__(cls) if missing is None else StandIn(missing)

    def __init__(self, package_name: str) -> None:
        self._package_path = Path(get_path(package_name, ""))
        self._parameters: dict[str, Any] = {}

    def yaml(self, file_path: str, parameter_namespace: str | None = None) -> Self:
        """Add the parameters of a YAML file, below a namespace if one is given."""
        content = load_yaml(self._package_path / file_path)
        if parameter_namespace:
            self._parameters.setdefault(parameter_namespace, {}).update(content)
        else:
            self._parameters.update(content)
        return self

    def file_parameter(self, parameter_name: str, file_path: str) -> Self:
        """Add the text of a file."""
        return self.parameter(parameter_name, load_file(self._package_path / file_path))

    def xacro_parameter(
        self, parameter_name: str, file_path: str, mappings: Mapping[str, str] | None = None
    ) -> Self:
        """Add the XML that xacro generates from a file."""
        text = load_xacro(self._package_path / file_path, mappings=mappings)
        return self.parameter(parameter_name, text)

    def parameter(self, parameter_name: str, parameter_value: ParameterValueType) -> Self:
        """Add a value."""
        self._parameters[parameter_name] = parameter_value
        return self

    def path_parameter(self, parameter_name: str, file_path: str) -> Self:
        """Add the path of a file."""
        return self.parameter(parameter_name, str(self._package_path / file_path))

    def to_dict(self) -> dict[str, Any]:
        """Return the parameters."""
        return self._parameters
