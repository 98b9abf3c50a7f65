"""`nav2_common.launch`: substitutions for parameter files."""

from __future__ import annotations

import os
import sys
import tempfile
from collections.abc import Callable, Iterator, Mapping
from functools import cache
from typing import Any

import yaml

from aionode._process.bounded_yaml import loaded_yaml
from aionode._process.temporary import temporary_folder
from launch.condition import Condition
from launch.launch_context import LaunchContext
from launch.substitution import (
    SomeSubstitutionsType,
    Substitution,
    SubstitutionFailure,
    normalize_to_list_of_substitutions,
    perform_substitutions,
    text_of,
)
from launch.substitutions import FileContent, LaunchConfiguration

__all__ = [
    "HasNodeParams",
    "LaunchConfigAsBool",
    "ParseMultiRobotPose",
    "ReplaceString",
    "RewrittenYaml",
]

Texts = Mapping[str, SomeSubstitutionsType]


class OfFile(Substitution):
    """A substitution derived from a file."""

    def __init__(self, source_file: SomeSubstitutionsType) -> None:
        self._source_file = normalize_to_list_of_substitutions(source_file)

    @property
    def name(self) -> list[Substitution]:
        """The path of the file."""
        return self._source_file

    def read(self, context: LaunchContext) -> str:
        """Return the text of the file.

        Raises:
            SubstitutionFailure: It cannot be read.
        """
        return FileContent(self._source_file).perform(context)

    def content(self, context: LaunchContext) -> Any:
        """Return the content of the YAML file.

        Raises:
            SubstitutionFailure: It cannot be read.
        """
        try:
            return loaded_yaml(self.read(context))
        except yaml.YAMLError as error:
            path = perform_substitutions(context, self._source_file)
            raise SubstitutionFailure(f"{path}: cannot be read as YAML: {error}") from error


class RewrittenYaml(OfFile):
    """The path of a copy of a YAML file in which keys and values are replaced."""

    def __init__(
        self,
        source_file: SomeSubstitutionsType,
        param_rewrites: Texts,
        root_key: SomeSubstitutionsType | None = None,
        key_rewrites: Texts | None = None,
        value_rewrites: Texts | None = None,
        convert_types: bool = False,
        out_dir: SomeSubstitutionsType | None = None,
    ) -> None:
        super().__init__(source_file)
        self.param_rewrites = param_rewrites
        self.root_key = root_key
        self.key_rewrites = key_rewrites or {}
        self.value_rewrites = value_rewrites or {}
        self.convert_types = convert_types
        self.out_dir = out_dir

    def perform(self, context: LaunchContext) -> str:
        """Return the path of the copy."""
        content = self.content(context)
        content = {} if content is None else content
        params = texts_of(context, self.param_rewrites)
        keys = texts_of(context, self.key_rewrites)
        values = texts_of(context, self.value_rewrites)
        for inner, key, path in list(places_in(content)):
            for name in (str(key), path):
                if name in params and (name == path or isinstance(key, str)):
                    inner[key] = self.converted(params[name])
        present = {path for _, _, path in places_in(content)}
        for path, text in params.items():
            if path not in present and "ros__parameters" in path.split("."):
                add(content, path.split("."), self.converted(text))
        content = with_keys(content, keys)
        content = with_values(content, lambda value: self.replaced(value, values))
        root = "" if self.root_key is None else text_of(context, self.root_key)
        folder = None if self.out_dir is None else text_of(context, self.out_dir)
        return written(yaml.safe_dump({root: content} if root else content), folder)

    def replaced(self, value: Any, values: Mapping[str, str]) -> Any:
        """Return the replacement for a value."""
        return self.converted(values[str(value)]) if str(value) in values else value

    def converted(self, text: str) -> Any:
        """Return the value of a text: true and false, and numbers if requested."""
        if self.convert_types:
            try:
                return float(text) if "." in text else int(text)
            except ValueError:
                pass
        return {"true": True, "false": False}.get(text.lower(), text)


class ReplaceString(OfFile):
    """The path of a copy of a file in which texts are replaced, or of the file if nothing is."""

    def __init__(
        self,
        source_file: SomeSubstitutionsType,
        replacements: Texts,
        condition: Condition | None = None,
    ) -> None:
        super().__init__(source_file)
        self.replacements = replacements
        self.condition = condition

    def perform(self, context: LaunchContext) -> str:
        """Return the path."""
        if self.condition is not None and not self.condition.evaluate(context):
            return perform_substitutions(context, self.name)
        text = self.read(context)
        for old, new in texts_of(context, self.replacements).items():
            text = text.replace(old, new)
        return written(text)


class HasNodeParams(OfFile):
    """Whether a parameter file contains parameters of a node."""

    def __init__(self, source_file: SomeSubstitutionsType, node_name: str) -> None:
        super().__init__(source_file)
        self.node_name = node_name

    def perform(self, context: LaunchContext) -> str:
        """Return True or False."""
        content = self.content(context)
        return str(isinstance(content, dict) and self.node_name in content)


class LaunchConfigAsBool(Substitution):
    """A launch configuration as a truth value, in any spelling."""

    def __init__(self, name: str) -> None:
        self.configuration = LaunchConfiguration(name)

    def perform(self, context: LaunchContext) -> str:
        """Return True or False."""
        value = context.perform_substitution(self.configuration).strip().lower()
        return str(value in {"true", "1", "yes", "on"})


class ParseMultiRobotPose(Substitution):
    """The poses of several robots, such as ``robot1={x: 1.0, yaw: 0.5}; robot2={y: 2.0}``.

    Args:
        robots_argument: A substitution with that text; or the name of a launch argument, whose
            value `value` takes from the command line, as in Humble and Jazzy.
    """

    def __init__(self, robots_argument: SomeSubstitutionsType) -> None:
        self._robots_argument = robots_argument

    def perform(self, context: LaunchContext) -> Any:
        """Return the pose of each robot by its name."""
        return poses_in(text_of(context, self._robots_argument))

    def value(self) -> dict[str, dict[str, Any]]:
        """Return the pose of each robot by its name; none without that argument."""
        start = f"{self._robots_argument}:="
        given = [each.removeprefix(start) for each in sys.argv if each.startswith(start)]
        return poses_in(given[0] if given else "")


def poses_in(text: str) -> dict[str, dict[str, Any]]:
    """Return the poses in a text; what a pose leaves out is 0."""
    poses: dict[str, dict[str, Any]] = {}
    for entry in text.split(";"):
        name, equals, written = entry.partition("=")
        if not equals:
            continue
        pose = loaded_yaml(written)
        if not isinstance(pose, dict):
            raise SubstitutionFailure(f"robots: {entry.strip()!r} is not NAME={{x: 1.0, yaw: 0.5}}")
        poses[name.strip()] = dict.fromkeys(("x", "y", "z", "roll", "pitch", "yaw"), 0.0) | pose
    return poses


def texts_of(context: LaunchContext, given: Texts) -> dict[str, str]:
    """Return the texts of substitutions by name."""
    return {name: text_of(context, value) for name, value in given.items()}


def places_in(content: Any, path: str = "") -> Iterator[tuple[Any, Any, str]]:
    """Yield each place within a value: its container, its key or index there, and its path."""
    pairs = list(content.items()) if isinstance(content, dict) else []
    pairs += enumerate(content) if isinstance(content, list) else []
    for key, value in pairs:
        inner = f"{path}.{key}".removeprefix(".")
        yield from places_in(value, inner)
        yield content, key, inner


def add(content: Any, keys: list[str], value: Any) -> None:
    """Set a value at the end of a path of keys."""
    *above, last = keys
    for key in above:
        content = content[int(key)] if isinstance(content, list) else content.setdefault(key, {})
    content[int(last) if isinstance(content, list) else last] = value


def with_keys(content: Any, keys: Mapping[str, str]) -> Any:
    """Return the content of a file with replaced keys."""
    if not isinstance(content, dict):
        return content
    return {keys.get(key, key): with_keys(value, keys) for key, value in content.items()}


def with_values(content: Any, replace: Callable[[Any], Any]) -> Any:
    """Return the content of a file with replaced values."""
    if isinstance(content, dict):
        return {key: with_values(value, replace) for key, value in content.items()}
    if isinstance(content, list):
        return [with_values(value, replace) for value in content]
    return replace(content)


@cache
def folder_of_copies() -> str:
    """Return the folder for modified copies, which is removed with this process."""
    return temporary_folder("aionode_launch_")


def written(text: str, folder: str | None = None) -> str:
    """Write a text to a new file, and return its path."""
    descriptor, path = tempfile.mkstemp(dir=folder or folder_of_copies(), suffix=".yaml")
    with os.fdopen(descriptor, "w", encoding="utf-8") as file:
        file.write(text)
    return path
