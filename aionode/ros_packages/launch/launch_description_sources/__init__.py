"""`launch.launch_description_sources`: included files."""

from __future__ import annotations

from importlib.machinery import SourceFileLoader
from importlib.util import module_from_spec, spec_from_loader
from types import ModuleType
from typing import Any, ClassVar

from launch.frontend.parser import ENDINGS, InvalidFrontendLaunchFileError
from launch.invalid_launch_file_error import InvalidLaunchFileError
from launch.launch_context import LaunchContext
from launch.substitution import (
    SomeSubstitutionsType,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)

__all__ = [
    "AnyLaunchDescriptionSource",
    "FrontendLaunchDescriptionSource",
    "InvalidFrontendLaunchFileError",
    "InvalidLaunchFileError",
    "InvalidPythonLaunchFileError",
    "LaunchDescriptionSource",
    "PythonLaunchDescriptionSource",
    "XMLLaunchDescriptionSource",
    "YAMLLaunchDescriptionSource",
    "get_launch_description_from_any_launch_file",
    "get_launch_description_from_frontend_launch_file",
    "get_launch_description_from_python_launch_file",
    "load_python_launch_file_as_module",
]


class LaunchDescriptionSource:
    """A description, or a file that contains one."""

    _LaunchDescriptionSource__kind: ClassVar[str] = "any"

    def __init__(
        self,
        launch_description: Any = None,
        location: SomeSubstitutionsType = "<script>",
        method: str = "unspecified mechanism from a script",
    ) -> None:
        self._LaunchDescriptionSource__description = launch_description
        self._LaunchDescriptionSource__subs = normalize_to_list_of_substitutions(location)
        self.location = "".join(
            getattr(sub, "text", sub.describe()) for sub in self._LaunchDescriptionSource__subs
        )
        self.method = method

    def get_launch_description(self, context: LaunchContext) -> Any:
        """Return the description, reading the file."""
        if self._LaunchDescriptionSource__description is not None:
            return self._LaunchDescriptionSource__description
        self.location = perform_substitutions(context, self._LaunchDescriptionSource__subs)
        return context.load_file(self.location, self._LaunchDescriptionSource__kind)

    def try_get_launch_description_without_context(self) -> Any:
        """Return the description if it is already known."""
        return self._LaunchDescriptionSource__description


class AnyLaunchDescriptionSource(LaunchDescriptionSource):
    """A file in Python, XML or YAML."""

    def __init__(self, launch_file_path: SomeSubstitutionsType, **_: Any) -> None:
        super().__init__(None, launch_file_path, "interpreted launch file")


class PythonLaunchDescriptionSource(AnyLaunchDescriptionSource):
    """A file in Python."""

    _LaunchDescriptionSource__kind = "python"


class FrontendLaunchDescriptionSource(AnyLaunchDescriptionSource):
    """A file in XML or YAML."""


class XMLLaunchDescriptionSource(AnyLaunchDescriptionSource):
    """A file in XML."""

    _LaunchDescriptionSource__kind = "xml"


class YAMLLaunchDescriptionSource(AnyLaunchDescriptionSource):
    """A file in YAML."""

    _LaunchDescriptionSource__kind = "yaml"


def load_python_launch_file_as_module(python_launch_file_path: str) -> ModuleType:
    """Run a Python file, whatever its extension, and return its module."""
    loader = SourceFileLoader("python_launch_file", python_launch_file_path)
    spec = spec_from_loader(loader.name, loader)
    assert spec is not None  # noqa: S101  # a loader of source always gives one
    module = module_from_spec(spec)
    loader.exec_module(module)
    return module


class InvalidPythonLaunchFileError(InvalidLaunchFileError):
    """A launch file in Python cannot be used."""


def get_launch_description_from_python_launch_file(python_launch_file_path: str) -> Any:
    """Return the description in a Python file, whatever its extension.

    Raises:
        InvalidPythonLaunchFileError: It fails, or contains no description.
    """
    return described(python_launch_file_path, ("py",), InvalidPythonLaunchFileError)


def get_launch_description_from_frontend_launch_file(launch_file_path: str) -> Any:
    """Return the description in a file in XML or YAML.

    Raises:
        InvalidFrontendLaunchFileError: It is not such a file.
    """
    return described(launch_file_path, ENDINGS, InvalidFrontendLaunchFileError)


def get_launch_description_from_any_launch_file(launch_file_path: str) -> Any:
    """Return the description in a file in Python, XML or YAML.

    Raises:
        InvalidLaunchFileError: It is not such a file.
    """
    return described(launch_file_path, ("py", *ENDINGS), InvalidLaunchFileError)


def described(path: str, endings: tuple[str, ...], failure: type[InvalidLaunchFileError]) -> Any:
    """Return the description in a file with one of these extensions."""
    from aionode.launch.running import description_of_text  # which imports this package

    try:
        return description_of_text(str(path), None, endings)
    except ValueError as error:
        extension = str(path).rpartition(".")[2]
        raise failure(extension, likely_errors=[error]) from error
