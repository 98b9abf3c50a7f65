"""The Python modules that generate_parameter_library would generate for a package."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import NamedTuple

from aionode._packages._cmake import calls_of
from aionode._packages._setup_files import parameter_calls

__all__ = ["ParameterModule", "parameter_modules"]


class ParameterModule(NamedTuple):
    """The source of a parameter module.

    Attributes:
        file: The YAML file that describes the parameters.
        validators: The module with validators of the package; empty without one.
    """

    file: Path
    validators: str


@cache
def parameter_modules(folder: Path, package: str) -> dict[str, ParameterModule]:
    """Return the modules that the rules of a package in a workspace generate, by name."""
    calls = [*calls_of(folder, package, "generate_parameter_module"), *parameter_calls(folder)]
    modules = {}
    for call in calls:
        name, file, validators = [*call, None, None, None][:3]
        if isinstance(name, str) and isinstance(file, str):
            modules[name] = ParameterModule(folder / file, validators or "")
    return modules
