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

Observations of one feature are put one after the other, so that arm and gripper may have topics of
their own; the same holds for actions. The picture of the reference makes a row: everything else is
as of its time, and an action as of one period later, as it answers the picture.
"""

from __future__ import annotations

import difflib
import math
import re
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, Final, Literal, NoReturn, TypeAlias

import msgspec
import numpy as np
import yaml

from aionode import image as pictures
from aionode._process.bounded_files import read_file
from aionode._process.bounded_yaml import composed_yaml, loaded_yaml
from aionode.errors import (
    ContractError,
    IdlError,
    InterfaceNotFoundError,
    InvalidTopicNameException,
    MessageError,
    escaped,
)
from aionode.interfaces import get_message
from aionode.learn._field_paths import check_path, filled, number_at
from aionode.message import Message, fields, from_builtins
from aionode.names import validate_topic_name

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping
    from os import PathLike

    import numpy.typing as npt

__all__ = ["Action", "Contract", "Feature", "Observation"]

Array: TypeAlias = "npt.NDArray[Any]"

IMAGES: Final = ("sensor_msgs/msg/Image", "sensor_msgs/msg/CompressedImage")

MOST_ENTRIES: Final = 100
"""Maximum observations and maximum actions of a contract."""

MOST_NUMBERS: Final = 10_000
"""Maximum numbers of a feature."""

FEATURE: Final = re.compile(r"[A-Za-z0-9_-]+(?:\.[A-Za-z0-9_-]+)*")
"""What a feature's name may be; it becomes a folder and a column."""

OWN: Final = ("timestamp", "frame_index", "episode_index", "index", "task_index", "task")
"""Columns that every data set has, besides the features."""


class Entry(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """What observations and actions have in common: a topic, and the numbers in its messages.

    Attributes:
        feature: The name of the feature in the data set, such as ``observation.state``.
        topic: The topic.
        type: The message type, such as ``sensor_msgs/msg/JointState``.
        fields: The path of each number in the message, such as ``position.shoulder``.
        names: The name of each number; without them, the paths.
        unit: The unit of the numbers, such as ``rad``; for people.
        max_age: The age in seconds up to which a message counts; without it, 1.5 periods.
        resample: Whether a number between two messages is computed from both, or is that of the
            earlier one; without it, floating-point numbers of observations are interpolated.
        stamp: The time of a message: that in its header, or that of its arrival; without it, the
            header's if there is one.
    """

    feature: str
    topic: str
    type: str
    fields: tuple[str, ...] = ()
    names: tuple[str, ...] = ()
    unit: str = ""
    max_age: float = 0.0
    resample: Literal["", "interpolate", "hold"] = ""
    stamp: Literal["", "capture", "receive"] = ""

    def __post_init__(self) -> None:
        """Check the entry, and put in what was left out."""
        if not FEATURE.fullmatch(self.feature) or self.feature in OWN:
            raise ValueError(
                f"feature: {self.feature!r}; letters, digits, _, - and dots fit, as in "
                "observation.state"
            )
        try:
            validate_topic_name(self.topic)
        except InvalidTopicNameException as error:
            raise ValueError(f"topic: {error}") from None
        if not (math.isfinite(self.max_age) and self.max_age >= 0):
            raise ValueError(f"max_age: {self.max_age:g}; a number of seconds fits")
        if not issubclass(self.message_type, Message):
            raise ValueError(f"type: {self.type} is no message")  # noqa: TRY004  # of a file
        self.check_fields()
        if self.names and len(self.names) != len(self.paths):
            raise ValueError(f"names: {len(self.names)} names for {len(self.paths)} numbers")
        if len(set(self.labels)) != len(self.labels):
            raise ValueError("names: a name is there twice; each needs its own")
        if self.stamp == "capture" and not self.has_header:
            raise ValueError(f"stamp: {self.type} has no header with a time; receive fits")

    def check_fields(self) -> None:
        """Raise ValueError for a path that is not in the message."""
        if not self.fields:
            raise ValueError(f"fields: none; paths in {self.type} fit, such as {self.example}")
        if len(self.fields) > MOST_NUMBERS:
            raise ValueError(f"fields: {len(self.fields)}; at most {MOST_NUMBERS} fit")
        cls = self.message_type
        for path in self.paths:
            try:
                check_path(cls, path)
            except ValueError as error:
                raise ValueError(f"fields: {path!r}: {error}") from None

    @property
    def message_type(self) -> Any:
        """The message class."""
        try:
            return get_message(self.type)
        except (InterfaceNotFoundError, IdlError, TypeError) as error:
            raise ValueError(f"type: {error}") from None

    @property
    def example(self) -> str:
        """The names of the message's fields, for error texts."""
        return ", ".join(each.name for each in fields(self.message_type))

    @property
    def paths(self) -> tuple[str, ...]:
        """The paths of the numbers, with ``[0]`` written as ``.0``."""
        return tuple(re.sub(r"\[(\w+)\]", r".\1", path) for path in self.fields)

    @property
    def labels(self) -> tuple[str, ...]:
        """The name of each number."""
        return self.names or self.paths

    @property
    def has_header(self) -> bool:
        """Whether messages have a header with a time."""
        return any(
            each.name == "header" and each.type.nested is get_message("std_msgs/msg/Header")
            for each in fields(self.message_type)
        )

    @property
    def is_captured(self) -> bool:
        """Whether the time of a message is that in its header."""
        return self.stamp != "receive" and self.has_header

    def value(self, message: Any) -> Array:
        """Return the numbers of a message as float32.

        Raises:
            MessageError: the message lacks one of them (a ValueError).
        """
        return np.array([number_at(message, path) for path in self.paths], np.float32)

    def time_of(self, message: Any, received: int) -> int:
        """Return the time of a message in nanoseconds, by its header or its arrival.

        A header without a time, which is 0, counts as one that is not there.
        """
        if not self.is_captured:
            return received
        stamp = message.header.stamp
        return int(stamp.sec) * 1_000_000_000 + int(stamp.nanosec) or received


class Observation(Entry, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A topic that a policy observes: numbers of its messages, or pictures.

    Attributes:
        image: ``color``, ``mono`` or ``depth`` if messages are pictures; None for numbers.
        height: The height of the pictures in pixels.
        width: Their width.
    """

    image: Literal["color", "mono", "depth"] | None = None
    height: int = 0
    width: int = 0

    def check_fields(self) -> None:
        """Raise ValueError for a path that is not in the message, or a picture without a size."""
        if self.image is None:
            if self.type in IMAGES:
                raise ValueError("image: none; color, mono or depth fits for pictures")
            super().check_fields()
        elif self.type not in IMAGES:
            raise ValueError(f"image: {self.type} is no picture; {' or '.join(IMAGES)} fits")
        elif self.fields or self.names:
            raise ValueError("fields: pictures have none")
        elif self.resample == "interpolate":
            raise ValueError("resample: pictures are not interpolated; hold fits")
        elif not (0 < self.height <= 16_384 and 0 < self.width <= 16_384):
            raise ValueError(
                f"height: {self.height} by width {self.width}; the pixels of the pictures fit, "
                "such as 480 by 640"
            )

    @property
    def is_interpolated(self) -> bool:
        """Whether a value between two messages is computed from both."""
        return self.image is None and self.resample != "hold"

    @property
    def shape(self) -> tuple[int, ...]:
        """The shape of a value: of a picture, rows, columns and, in colour, three channels."""
        if self.image is None:
            return (len(self.paths),)
        size = (self.height, self.width)
        return (*size, 3) if self.image == "color" else size

    def value(self, message: Any) -> Array:
        """Return what a message shows: float32 numbers, or the pixels of a picture.

        Pictures are uint8, in colour red, green and blue; depths are float32 metres, where 0 and
        NaN are unknown.

        Raises:
            MessageError: the message lacks a number, or is no such picture (a ValueError).
        """
        if self.image is None:
            return super().value(message)
        if self.type == IMAGES[1]:
            message = pictures.decompress(message)
        pixels = pixels_of(message, self.image)
        if pixels.shape != self.shape:
            raise MessageError(
                f"{self.topic}: picture",
                f"{pixels.shape[1]} by {pixels.shape[0]} pixels; the contract has {self.width} by "
                f"{self.height}",
            )
        return pixels


class Action(Entry, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A topic that a policy commands.

    Attributes:
        lower: The least value of each number, or one for all; without it, none.
        upper: The greatest value of each number, or one for all.
        stop: What stops the robot: ``zero`` in all numbers, ``hold`` for the last command again,
            or the fields of a message.
        template: The other fields of the message, such as ``{header: {frame_id: base}}``.
        lease_sec: How long after the last command the stop is sent.
    """

    stop: Literal["zero", "hold"] | dict[str, Any]
    lower: float | tuple[float, ...] = -math.inf
    upper: float | tuple[float, ...] = math.inf
    template: dict[str, Any] = {}
    lease_sec: float = 0.3

    def __post_init__(self) -> None:
        """Check the entry, its limits and its messages."""
        super().__post_init__()
        for name, limit in (("lower", self.lower), ("upper", self.upper)):
            if isinstance(limit, tuple) and len(limit) != len(self.paths):
                raise ValueError(f"{name}: {len(limit)} limits for {len(self.paths)} numbers")
        if not np.all(self.limits[0] <= self.limits[1]):
            raise ValueError("lower: greater than upper, or no number")
        if not (math.isfinite(self.lease_sec) and self.lease_sec > 0):
            raise ValueError(f"lease_sec: {self.lease_sec:g}; a number of seconds fits")
        for name, make in (("template", self.zero), ("stop", self.stop_message)):
            try:
                make()
            except (MessageError, KeyError, TypeError, AttributeError) as error:
                raise ValueError(f"{name}: {error}") from None

    @property
    def is_interpolated(self) -> bool:
        """Whether a value between two messages is computed from both."""
        return self.resample == "interpolate"

    @property
    def shape(self) -> tuple[int, ...]:
        """The shape of a value."""
        return (len(self.paths),)

    @property
    def limits(self) -> tuple[Array, Array]:
        """The least and the greatest value of each number."""
        lower, upper = (
            np.broadcast_to(np.array(limit, np.float64), self.shape)
            for limit in (self.lower, self.upper)
        )
        return lower, upper

    def clamped(self, values: Array) -> tuple[Array, int]:
        """Return values within the limits, and how many of them were not.

        Raises:
            ContractError: they are not as many as the numbers, or not finite (a ValueError).
        """
        given = np.asarray(values, np.float64)
        if given.shape != self.shape or not np.isfinite(given).all():
            raise ContractError(
                self.topic,
                self.feature,
                f"{escaped(str(given)[:200])}; {len(self.paths)} finite numbers fit: "
                f"{', '.join(self.labels[:20])}",
            )
        inside = np.clip(given, *self.limits)
        return inside, int((inside != given).sum())

    def message(self, values: Array, stamp: Any = None) -> Any:
        """Return the message that commands values, which are clamped to the limits.

        Args:
            values: One number for each name.
            stamp: The time for the header, a ``builtin_interfaces/msg/Time``, if it has one.

        Raises:
            ContractError: they are not as many as the numbers, or not finite (a ValueError).
        """
        inside, _ = self.clamped(values)
        return self.stamped(self.filled(inside.tolist()), stamp)

    def zero(self) -> Any:
        """Return the message with zero in all numbers, whatever the limits."""
        return self.filled([0.0] * len(self.paths))

    def stop_message(self, last: Any = None) -> Any:
        """Return the message that stops the robot.

        Args:
            last: The last command, which ``stop: hold`` sends again; None if there was none: then
                there is nothing to hold, and the result is None.
        """
        if self.stop == "hold":
            return last
        return self.zero() if self.stop == "zero" else from_builtins(self.message_type, self.stop)

    def filled(self, values: list[float]) -> Any:
        """Return a message of the template with values."""
        return filled(self.message_type, self.paths, values, self.template)

    def stamped(self, message: Any, stamp: Any) -> Any:
        """Put a time into the header of a message that has one."""
        if stamp is not None and self.has_header:
            message.header.stamp = stamp
        return message


@dataclass(frozen=True, slots=True)
class Feature:
    """A feature of the data set, from one topic or several.

    Attributes:
        name: Its name, such as ``observation.state``.
        kind: ``numbers``, ``color``, ``mono`` or ``depth``.
        shape: The shape of a value.
        labels: The name of each number; empty for pictures.
        entries: The observations or actions that it consists of, in order.
    """

    name: str
    kind: str
    shape: tuple[int, ...]
    labels: tuple[str, ...]
    entries: tuple[Observation | Action, ...]


class Contract(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True, dict=True):
    """What a policy observes and commands; one file records, converts and drives.

    Attributes:
        observations: What it observes.
        actions: What it commands.
        fps: The frames of a second, as of the reference.
        reference: The topic whose messages make the rows; without it, that of the first picture,
            or of the first observation.
        task: What the robot is to do, in words; may be empty, and be given to each recording.
        robot: The type of the robot, such as ``so101``; for people.
        gap: What a gap of more than 1.5 periods between rows does: ``end`` ends the episode, and
            what follows is another one; ``refuse`` refuses the episode.
    """

    observations: tuple[Observation, ...]
    actions: tuple[Action, ...]
    fps: int
    reference: str = ""
    task: str = ""
    robot: str = ""
    gap: Literal["end", "refuse"] = "end"

    def __post_init__(self) -> None:
        """Check what the entries have in common."""
        if not 1 <= self.fps <= 1000:
            raise ValueError(f"fps: {self.fps}; 1 to 1000 fits")
        for name, given in (("observations", self.observations), ("actions", self.actions)):
            if not 1 <= len(given) <= MOST_ENTRIES:
                raise ValueError(f"{name}: {len(given)}; 1 to {MOST_ENTRIES} fit")
        topics = [each.topic for each in self.observations]
        if self.reference and self.reference not in topics:
            near = "".join(difflib.get_close_matches(self.reference, topics, 1))
            raise ValueError(
                f"reference: {self.reference!r} is no topic of an observation"
                + (f"; did you mean {near}?" if near else f"; {', '.join(topics)} fit")
            )
        for name in {each.feature for each in self.entries}:
            self.check_feature([each for each in self.entries if each.feature == name])

    def check_feature(self, entries: list[Observation | Action]) -> None:
        """Raise ValueError if the entries of one feature cannot be put together."""
        name = entries[0].feature
        if len({type(each) for each in entries}) > 1:
            raise ValueError(f"{name}: both an observation and an action; each needs its own name")
        if len(entries) > 1 and any(getattr(each, "image", None) for each in entries):
            raise ValueError(f"{name}: two entries; a feature with a picture has one")
        labels = [label for each in entries for label in each.labels]
        if len(set(labels)) != len(labels):
            raise ValueError(f"{name}: two numbers of one name; give each its own in names")
        if len({(each.topic, each.type) for each in self.entries}) > len(
            {each.topic for each in self.entries}
        ):
            raise ValueError(f"{name}: its topic has another type in another entry")

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
            path: What errors call it.

        Raises:
            ContractError: they are not a contract (a ValueError).
        """
        return contract_from(given, path or "given", None)

    def to_dict(self) -> dict[str, Any]:
        """Return the plain values that `from_dict` takes."""
        given: dict[str, Any] = msgspec.to_builtins(self)
        for entry in (*given["observations"], *given["actions"]):
            for key in [key for key, value in entry.items() if value in ((), [], "", None, {}, 0)]:
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
        """The observation that makes the rows."""
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
        """Return the age in seconds up to which a message of an entry counts."""
        return entry.max_age or 1.5 * self.period

    def split(self, feature: str, values: Array) -> list[tuple[Observation | Action, Array]]:
        """Return the part of a feature's value that each of its entries has."""
        entries = self.features[feature].entries
        if len(entries) == 1:
            return [(entries[0], values)]
        ends = np.cumsum([each.shape[0] for each in entries])[:-1]
        return list(zip(entries, np.split(np.asarray(values), ends), strict=True))


def feature_of(entries: list[Observation | Action]) -> Feature:
    """Return the feature of its entries."""
    first = entries[0]
    if isinstance(first, Observation) and first.image:
        return Feature(first.feature, first.image, first.shape, (), (first,))
    labels = tuple(label for each in entries for label in each.labels)
    return Feature(first.feature, "numbers", (len(labels),), labels, tuple(entries))


def pixels_of(message: Any, kind: str) -> Array:
    """Return the pixels of an Image: uint8 colours or greys, or float32 depths in metres.

    Raises:
        MessageError: it cannot be shown so (a ValueError).
    """
    encoding = {"color": "rgb8", "mono": "mono8", "depth": "passthrough"}[kind]
    try:
        pixels = pictures.to_numpy(message, encoding)
    except MessageError:
        raise
    except ValueError as error:
        raise MessageError("sensor_msgs/msg/Image.encoding", str(error)) from error
    if kind != "depth":
        return pixels
    if pixels.ndim != 2 or pixels.dtype.kind not in "uf":
        problem = f"{message.encoding!r}; 16UC1 and 32FC1 fit for depths"
        raise MessageError("sensor_msgs/msg/Image.encoding", problem)
    scale = np.float32(0.001 if pixels.dtype.kind == "u" else 1.0)
    return pixels.astype(np.float32) * scale


# Errors with the line of what they are about


def contract_from(given: object, path: str, node: Any) -> Contract:
    """Return the contract of plain values; errors name the line in the node of the file."""
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
            f"did you mean {near[0]}?" if near else f"{', '.join(keys_at(parts))} fit"
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
    """Return the keys that fit at a place."""
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
    """Yield the nodes on the way to a place, as far as they are there."""
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
    """Raise the error for a key that a mapping has twice, of which YAML takes the last."""
    if isinstance(node, yaml.MappingNode):
        seen: set[str] = set()
        for key, value in node.value:
            name = str(key.value)
            if name in seen:
                line = key.start_mark.line + 1
                shown = escaped(name[:100], one_line=True)
                raise ContractError(path, f"line {line}: {shown}", "there twice; once fits")
            seen.add(name)
            check_keys(path, value)
    elif isinstance(node, yaml.SequenceNode):
        for value in node.value:
            check_keys(path, value)
