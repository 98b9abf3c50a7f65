"""`launch_ros.substitutions`: where packages are, and values that nodes get."""

from __future__ import annotations

from typing import Any

from aionode.launch._launch.launch_context import LaunchContext
from aionode.launch._launch.substitution import (
    SomeSubstitutionsType,
    Substitution,
    SubstitutionFailure,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)

__all__ = [
    "ExecutableInPackage",
    "FindPackage",
    "FindPackagePrefix",
    "FindPackageShare",
    "Parameter",
]


class FindPackage(Substitution):
    """A folder of a package."""

    def __init__(self, package: SomeSubstitutionsType) -> None:
        self.package = normalize_to_list_of_substitutions(package)

    def find(self, package_name: str, context: LaunchContext) -> str:
        """Return the folder."""
        raise NotImplementedError(f"{type(self).__name__}.find")

    def perform(self, context: LaunchContext) -> str:
        """Return the folder."""
        return self.find(perform_substitutions(context, self.package), context)

    def describe(self) -> str:
        """Return which package it is."""
        return f"{type(self).__name__}({''.join(sub.describe() for sub in self.package)})"


class FindPackagePrefix(FindPackage):
    """The folder into which a package was installed."""

    def find(self, package_name: str, context: LaunchContext) -> str:
        """Return the folder."""
        packages = context.packages
        return str(packages.sources().get(package_name) or packages.prefix(package_name))


class FindPackageShare(FindPackage):
    """The folder with the data of a package."""

    def find(self, package_name: str, context: LaunchContext) -> str:
        """Return the folder."""
        return str(context.packages.share(package_name))


class ExecutableInPackage(Substitution):
    """The path of an executable of a package."""

    def __init__(self, executable: SomeSubstitutionsType, package: SomeSubstitutionsType) -> None:
        self.executable = normalize_to_list_of_substitutions(executable)
        self.package = normalize_to_list_of_substitutions(package)

    def perform(self, context: LaunchContext) -> str:
        """Return the path."""
        executable = perform_substitutions(context, self.executable)
        package = perform_substitutions(context, self.package)
        return context.packages.executable(package, executable).target


class Parameter(Substitution):
    """The value of a parameter that `SetParameter` has set for all nodes."""

    def __init__(
        self, name: SomeSubstitutionsType, *, default: SomeSubstitutionsType | None = None
    ) -> None:
        self.name = normalize_to_list_of_substitutions(name)
        self.default = default

    @classmethod
    def of_words(cls, *words: Any) -> Parameter:
        """Return that of ``$(param name default)``."""
        return cls(words[0], default=words[1] if len(words) > 1 else None)

    def perform(self, context: LaunchContext) -> str:
        """Return the value, or the default."""
        name = perform_substitutions(context, self.name)
        for known in context.launch_configurations.get("global_params", ()):
            if isinstance(known, tuple) and known[0] == name:
                return str(known[1])
        if self.default is None:
            raise SubstitutionFailure(f"parameter '{name}' is not set for all nodes")
        return perform_substitutions(context, normalize_to_list_of_substitutions(self.default))
