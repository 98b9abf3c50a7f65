"""Contracts: which topics a policy observes and commands, in one file for training and driving.

::

    task: pick the cube
    fps: 30
    reference: /camera/image_raw
    observations:
      - feature: observation.images.front
        topic: /camera/image_raw
        type: sensor_msgs/msg/Image
        image: color
        height: 480
        width: 640
        max_age: 0.05
      - feature: observation.state
        topic: /joint_states
        type: sensor_msgs/msg/JointState
        fields: [position.shoulder, position.elbow]
        names: [shoulder, elbow]
        unit: rad
        max_age: 0.05
    actions:
      - feature: action
        topic: /arm/command
        type: std_msgs/msg/Float64MultiArray
        fields: [data.0, data.1]
        names: [shoulder, elbow]
        unit: rad/s
        lower: [-1.0, -1.0]
        upper: [1.0, 1.0]
        stop: zero

Observations of one feature are concatenated, so that arm and gripper may have topics of
their own; the same holds for actions. Each message of the reference topic makes a row, or every
second one of a camera at twice the rate: observations are taken as of its time, and actions as of
one period later, since they answer that observation.
"""

from __future__ import annotations

import difflib
import math
import re
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, Final, Literal, NoReturn

import msgspec
import numpy as np
import yaml

from aionode._process.bounded_files import read_file
from aionode._process.bounded_yaml import composed_yaml, loaded_yaml
from aionode.errors import (
    ContractError,
    escaped,
)
from aionode.learn._entries import Action, Array, Observation

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping
    from os import PathLike

    from aionode import Node
    from aionode.learn._actor import Actor
    from aionode.learn._observer import Observations

__all__ = ["Action", "Contract", "Feature", "Observation"]

MAX_ENTRIES: Final = 100
"""Maximum number of observations, and of actions, in a contract."""


@dataclass(frozen=True, slots=True)
class Feature:
    """A feature of the data set, from one topic or several.

    Attributes:
        name: Its name, such as ``observation.state``.
        kind: ``numbers``, ``color``, ``mono`` or ``depth``.
        shape: The shape of a value.
        labels: The name of each number; empty for images.
        entries: The observations or actions that it consists of, in order.
    """

    name: str
    kind: str
    shape: tuple[int, ...]
    labels: tuple[str, ...]
    entries: tuple[Observation | Action, ...]


class Contract(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True, dict=True):
    """What a policy observes and commands: one file for recording, converting and driving.

    Attributes:
        observations: What it observes.
        actions: What it commands.
        fps: The frames per second of the reference.
        reference: The topic whose messages make the rows; by default, that of the first image
            observation, or else of the first observation.
        task: What the robot is to do, in words; may be empty and be given for each recording.
        robot: The type of the robot, such as ``so101``, for human readers.
        gap: How to treat a gap of more than 1.5 periods between rows: ``end`` ends the episode
            there and starts another one; ``refuse`` refuses the recording.
    """

    observations: tuple[Observation, ...]
    actions: tuple[Action, ...]
    fps: int
    reference: str = ""
    task: str = ""
    robot: str = ""
    gap: Literal["end", "refuse"] = "end"

    def __post_init__(self) -> None:
        """Check rules that concern several entries."""
        if not 1 <= self.fps <= 1000:
            raise ValueError(f"fps: {self.fps}; use 1 to 1000")
        for name, given in (("observations", self.observations), ("actions", self.actions)):
            if not 1 <= len(given) <= MAX_ENTRIES:
                raise ValueError(f"{name}: {len(given)} given; use 1 to {MAX_ENTRIES}")
        topics = [each.topic for each in self.observations]
        if self.reference and self.reference not in topics:
            near = "".join(difflib.get_close_matches(self.reference, topics, 1))
            raise ValueError(
                f"reference: {self.reference!r} is not the topic of an observation"
                + (f"; did you mean {near}?" if near else f"; use one of {', '.join(topics)}")
            )
        for name in {each.feature for each in self.entries}:
            self.check_feature([each for each in self.entries if each.feature == name])

    def check_feature(self, entries: list[Observation | Action]) -> None:
        """Raise ValueError if the entries of one feature cannot be combined."""
        name = entries[0].feature
        if len({type(each) for each in entries}) > 1:
            raise ValueError(f"{name}: both an observation and an action; each needs its own name")
        if len(entries) > 1 and any(getattr(each, "image", None) for each in entries):
            raise ValueError(f"{name}: several entries; an image feature has a single one")
        labels = [label for each in entries for label in each.labels]
        if len(set(labels)) != len(labels):
            raise ValueError(f"{name}: numbers with the same name; give each its own in names")
        if len({(each.topic, each.type) for each in self.entries}) > len(
            {each.topic for each in self.entries}
        ):
            raise ValueError(f"{name}: its topic has a different type in another entry")

    @classmethod
    def load(cls, path: str | PathLike[str]) -> Contract:
        """Read a contract from a YAML file.

        Raises:
            ContractError: the file cannot be read, or is not a contract (a ValueError).
        """
        name = str(path)
        try:
            text = read_file(path)
        except OSError as error:
            problem = f"cannot be read: {error.strerror}"
            raise ContractError(name, "", problem) from error
        try:
            node, given = composed_yaml(text), loaded_yaml(text)
        except yaml.YAMLError as error:
            problem = f"not YAML: {' '.join(str(error).split())}"
            raise ContractError(name, "", problem) from error
        check_keys(name, node)
        return contract_from(given, name, node)

    @classmethod
    def from_dict(cls, given: Mapping[str, Any], path: str = "") -> Contract:
        """Create a contract from plain values, as in the file.

        Args:
            given: The values.
            path: The name that errors use.

        Raises:
            ContractError: the values are not a contract (a ValueError).
        """
        return contract_from(given, path or "given", None)

    def to_dict(self) -> dict[str, Any]:
        """Return the plain values that `from_dict` takes."""
        given: dict[str, Any] = listed(msgspec.to_builtins(self))
        for entry in (*given["observations"], *given["actions"]):
            for key, value in list(entry.items()):
                # For `lower`, `upper` and `infinity`, 0 is not the default.
                if value in ((), [], "", None, {}) or (
                    value == 0 and key in ("height", "width", "max_age")
                ):
                    del entry[key]
            for key in ("lower", "upper"):
                if key in entry and entry[key] in (math.inf, -math.inf):
                    del entry[key]
        return given

    @property
    def entries(self) -> tuple[Observation | Action, ...]:
        """Observations and actions."""
        return (*self.observations, *self.actions)

    @property
    def topics(self) -> dict[str, str]:
        """The type of each topic."""
        return {each.topic: each.type for each in self.entries}

    @property
    def period(self) -> float:
        """The seconds from one row to the next."""
        return 1 / self.fps

    @property
    def main(self) -> Observation:
        """The observation whose messages make the rows."""
        wanted = [each for each in self.observations if each.topic == self.reference]
        images = [each for each in self.observations if each.image]
        return (wanted or images or list(self.observations))[0]

    @cached_property
    def features(self) -> dict[str, Feature]:
        """The features by name, in the order of the file."""
        found: dict[str, list[Observation | Action]] = {}
        for each in self.entries:
            found.setdefault(each.feature, []).append(each)
        return {name: feature_of(entries) for name, entries in found.items()}

    def max_age(self, entry: Observation | Action) -> float:
        """Return the maximum age of a message of an entry, in seconds."""
        return entry.max_age or 1.5 * self.period

    def observe(self, node: Node) -> Observations:
        """Observe the robot, within ``async with``.

        ::

            async with contract.observe(node) as observations:
                async for seen in observations.at(30):
                    print(seen.at, seen.values["observation.state"], seen.age)

        Args:
            node: The node whose subscriptions and clock are used.
        """
        from aionode.learn._observer import Observations  # only for programs that drive or watch

        return Observations(node, self.observations, self.main, self.fps, self.max_age)

    def act(self, node: Node, *, blend_sec: float = 0.0) -> Actor:
        """Send the actions of a policy, each at its time, within ``async with``.

        ::

            async with contract.act(node) as actor:
                await actor.run(policy)

        Args:
            node: The node whose publishers and clock are used.
            blend_sec: How long a new chunk is blended with the rest of the last one, from
                entirely the old to entirely the new.

        Raises:
            ContractError: a lease is shorter than the time between two actions (a ValueError).
        """
        from aionode.learn._actor import Actor  # for programs that drive

        return Actor(node, self.actions, self.fps, lambda: self.observe(node), blend_sec)

    def split(self, feature: str, values: Array) -> list[tuple[Observation | Action, Array]]:
        """Return a feature's value, split into the parts of its entries."""
        entries = self.features[feature].entries
        if len(entries) == 1:
            return [(entries[0], values)]
        ends = np.cumsum([each.shape[0] for each in entries])[:-1]
        return list(zip(entries, np.split(np.asarray(values), ends), strict=True))


def listed(value: Any) -> Any:
    """Return plain values with lists instead of tuples, as in files."""
    if isinstance(value, dict):
        return {key: listed(each) for key, each in value.items()}
    return [listed(each) for each in value] if isinstance(value, list | tuple) else value


def feature_of(entries: list[Observation | Action]) -> Feature:
    """Return the feature that entries form."""
    first = entries[0]
    if isinstance(first, Observation) and first.image:
        return Feature(first.feature, first.image, first.shape, (), (first,))
    labels = tuple(label for each in entries for label in each.labels)
    return Feature(first.feature, "numbers", (len(labels),), labels, tuple(entries))


# Errors that name the line


def contract_from(given: object, path: str, node: Any) -> Contract:
    """Return the contract from plain values; errors name the line in the YAML node."""
    try:
        return msgspec.convert(given, Contract)
    except msgspec.ValidationError as error:
        problem, _, place = str(error).partition(" - at `")
        refuse(path, node, place.rstrip("`"), problem)


def refuse(path: str, node: Any, place: str, problem: str) -> NoReturn:
    """Raise the error for a problem at a place such as ``$.observations[0].max_age``."""
    parts: list[str | int] = [
        int(index) if index else name
        for name, index in re.findall(r"\.([A-Za-z_]\w*)|\[(\d+)\]", place)
    ]
    key = re.match(r"([a-z_]+): ", problem)
    unknown = re.fullmatch(r"Object contains unknown field `(.*)`", problem, re.DOTALL)
    if unknown is not None:
        near = difflib.get_close_matches(unknown[1][:100], keys_at(parts), 1)
        problem = "no such key; " + (
            f"did you mean {near[0]}?" if near else f"use one of {', '.join(keys_at(parts))}"
        )
        parts.append(unknown[1])
    elif key is not None and key[1] in keys_at(parts):
        parts.append(key[1])
        problem = problem[key.end() :]
    where = "".join(
        f"[{each}]" if isinstance(each, int) else f".{each}" for each in parts
    ).removeprefix(".")
    line = line_of(node, parts)
    shown = [f"line {line}"] * bool(line) + [escaped(where, one_line=True)] * bool(where)
    raise ContractError(path, ": ".join(shown), problem)


def keys_at(parts: list[str | int]) -> tuple[str, ...]:
    """Return the keys that are allowed at a place."""
    names = {"observations": Observation, "actions": Action}
    cls = names.get(str(parts[0]), Contract) if len(parts) > 1 else Contract
    return tuple(cls.__struct_fields__)


def line_of(node: Any, parts: list[str | int]) -> int:
    """Return the line of a place in a file, or of the nearest one around it; 0 without a file."""
    line = 0
    for found in nodes_along(node, parts):
        line = found.start_mark.line + 1
    return line


def nodes_along(node: Any, parts: list[str | int]) -> Iterator[Any]:
    """Yield the nodes on the path to a place, as far as they exist."""
    if node is not None:
        yield node
    for part in parts:
        if isinstance(node, yaml.MappingNode):
            pairs = [pair for pair in node.value if pair[0].value == part]
            if not pairs:
                return
            yield pairs[-1][0]
            node = pairs[-1][1]
        elif isinstance(node, yaml.SequenceNode) and isinstance(part, int):
            if part >= len(node.value):
                return
            node = node.value[part]
            yield node
        else:
            return


def check_keys(path: str, node: Any) -> None:
    """Raise an error for a key that a mapping has twice; YAML would keep only the last value."""
    if isinstance(node, yaml.MappingNode):
        seen: set[str] = set()
        for key, value in node.value:
            name = str(key.value)
            if name in seen:
                line = key.start_mark.line + 1
                shown = escaped(name[:100], one_line=True)
                raise ContractError(path, f"line {line}: {shown}", "given twice; remove one")
            seen.add(name)
            check_keys(path, value)
    elif isinstance(node, yaml.SequenceNode):
        for value in node.value:
            check_keys(path, value)
