"""`launch_ros.substitutions`: the folders of packages, and the parameters of nodes."""

from __future__ import annotations

from importlib import import_module

from launch.launch_context import LaunchContext
from launch.substitution import (
    SomeSubstitutionsType,
    Substitution,
    SubstitutionFailure,
    normalize_to_list_of_substitutions,
    perform_substitutions,
    text_of,
)

__all__ = [
    "ExecutableInPackage",
    "FindPackage",
    "FindPackagePrefix",
    "FindPackageShare",
    "Parameter",
]

INDEX = "ament_index_python.packages"
"""The module that finds packages: aionode's, which also knows the workspace."""


class FindPackage(Substitution):
    """A folder of a package."""

    def __init__(self, package: SomeSubstitutionsType) -> None:
        self.package = normalize_to_list_of_substitutions(package)

    def find(self, package_name: str) -> str:
        """Return the folder; programs also call this directly."""
        raise NotImplementedError(f"{type(self).__name__}.find")

    def perform(self, context: LaunchContext) -> str:
        """Return the folder."""
        return self.find(perform_substitutions(context, self.package))

    def describe(self) -> str:
        """Return the package that it finds."""
        return f"{type(self).__name__}({''.join(sub.describe() for sub in self.package)})"


class FindPackagePrefix(FindPackage):
    """The folder into which a package was installed."""

    def find(self, package_name: str) -> str:
        """Return the folder."""
        return str(import_module(INDEX).get_package_prefix(package_name))


class FindPackageShare(FindPackage):
    """The folder with the data of a package."""

    def find(self, package_name: str) -> str:
        """Return the folder."""
        return str(import_module(INDEX).get_package_share_directory(package_name))


class ExecutableInPackage(Substitution):
    """The path of an executable of a package."""

    def __init__(self, executable: SomeSubstitutionsType, package: SomeSubstitutionsType) -> None:
        self.executable = normalize_to_list_of_substitutions(executable)
        self.package = normalize_to_list_of_substitutions(package)

    def _ExecutableInPackage__names(self, context: LaunchContext) -> tuple[str, str]:
        """Return the names of the package and of the executable."""
        return (
            perform_substitutions(context, self.package),
            perform_substitutions(context, self.executable),
        )

    def _ExecutableInPackage__command(self, context: LaunchContext) -> list[str]:
        """Return the command that starts the executable."""
        return context.packages.command(*self._ExecutableInPackage__names(context))

    def perform(self, context: LaunchContext) -> str:
        """Return the path."""
        program = context.packages.executable(*self._ExecutableInPackage__names(context))
        if program.is_standard:
            raise SubstitutionFailure(
                f"{program.name} of {program.package} is a program of aionode; it has no "
                "path, but can be the first word of a command"
            )
        if program.root is not None:
            raise SubstitutionFailure(
                f"{program.name} of {program.package} is a function, {program.target}, until the "
                "package is built; it has no path, but can be the first word of a command"
            )
        return program.target


class Parameter(Substitution):
    """The value of a parameter that `SetParameter` has set for all nodes."""

    _Substitution__second_word = "default"

    def __init__(
        self, name: SomeSubstitutionsType, *, default: SomeSubstitutionsType | None = None
    ) -> None:
        self.name = normalize_to_list_of_substitutions(name)
        self._Parameter__default = default

    def perform(self, context: LaunchContext) -> str:
        """Return the value, or the default."""
        name = perform_substitutions(context, self.name)
        for known in context.launch_configurations.get("global_params", ()):
            if isinstance(known, tuple) and known[0] == name:
                return str(known[1])
        if self._Parameter__default is None:
            raise SubstitutionFailure(f"parameter '{name}' is not set for all nodes")
        return text_of(context, self._Parameter__default)
