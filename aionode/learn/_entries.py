"""The entries of a contract: one topic each, and the numbers or images in its messages."""

from __future__ import annotations

import math
import re
from functools import lru_cache
from typing import Any, Final, Literal, TypeAlias

import msgspec
import numpy as np
import numpy.typing as npt

from aionode import image as pictures
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

__all__ = ["Action", "Array", "Entry", "Observation"]

Array: TypeAlias = "npt.NDArray[Any]"

IMAGES: Final = ("sensor_msgs/msg/Image", "sensor_msgs/msg/CompressedImage")

MAX_NUMBERS: Final = 10_000
"""Maximum count of numbers in a feature."""

FEATURE: Final = re.compile(r"[A-Za-z0-9_-]+(?:\.[A-Za-z0-9_-]+)*")
"""The pattern of a feature's name, which becomes a folder and a column."""

OWN: Final = (
    "age",
    "episode_index",
    "frame_index",
    "index",
    "stamp",
    "task",
    "task_index",
    "timestamp",
)
"""Columns that every data set has, besides the features."""


class Entry(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """The base of observations and actions: a topic, and the numbers in its messages.

    Attributes:
        feature: The name of the feature in the data set, such as ``observation.state``.
        topic: The topic.
        type: The message type, such as ``sensor_msgs/msg/JointState``.
        fields: The path of each number in the message, such as ``position.shoulder``.
        names: The name of each number; by default, the paths.
        unit: The unit of the numbers, such as ``rad``, for human readers.
        max_age: The maximum age of a message in seconds; by default, 1.5 periods.
        resample: Whether a number between two messages is interpolated, or is that of the
            earlier one; by default, floating-point numbers of observations are interpolated.
        stamp: Which time a message has: ``capture``, that in its header, or ``receive``, that of
            its arrival; by default, the header's if there is one.
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
        """Check the entry, and fill in defaults."""
        if not FEATURE.fullmatch(self.feature) or self.feature in OWN:
            raise ValueError(
                f"feature: {self.feature!r}; use letters, digits, _, - and dots, as in "
                "observation.state"
            )
        try:
            validate_topic_name(self.topic)
        except InvalidTopicNameException as error:
            raise ValueError(f"topic: {error}") from None
        if not (math.isfinite(self.max_age) and self.max_age >= 0):
            raise ValueError(f"max_age: {self.max_age:g}; use a number of seconds")
        if not issubclass(self.message_type, Message):
            raise ValueError(f"type: {self.type} is not a message type")  # noqa: TRY004  # of a file
        self.check_fields()
        if self.names and len(self.names) != len(self.paths):
            raise ValueError(f"names: {len(self.names)} names for {len(self.paths)} numbers")
        if len(set(self.labels)) != len(self.labels):
            raise ValueError("names: a name is given twice; each number needs its own")
        if self.stamp == "capture" and not self.has_header:
            raise ValueError(f"stamp: {self.type} has no header with a time; use receive")

    def check_fields(self) -> None:
        """Raise ValueError for a path that the message does not have."""
        if not self.fields:
            raise ValueError(f"fields: none; give paths in {self.type}, such as {self.example}")
        if len(self.fields) > MAX_NUMBERS:
            raise ValueError(f"fields: {len(self.fields)} given; use at most {MAX_NUMBERS}")
        cls = self.message_type
        for path in self.paths:
            try:
                check_path(cls, path)
            except ValueError as error:
                raise ValueError(f"fields: {path!r}: {error}") from None

    @property
    def has_floats(self) -> bool:
        """Whether all numbers are floating-point numbers."""
        return are_floats(self.message_type, self.paths)

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
            MessageError: the message lacks one of them, or one is not finite (a ValueError).
        """
        numbers = np.array([number_at(message, path) for path in self.paths], np.float64)
        self.replace_infinities(numbers)
        with np.errstate(over="ignore"):  # numbers too large for float32 become infinite
            found = numbers.astype(np.float32)
        if not np.isfinite(found).all():
            place = int(np.flatnonzero(~np.isfinite(found))[0])
            raise MessageError(f"{self.type}.{self.paths[place]}", f"{found[place]}, not finite")
        return found

    def replace_infinities(self, numbers: npt.NDArray[np.float64]) -> None:
        """Replace infinite numbers that have a meaning; the base class knows none."""

    def time_of(self, message: Any, received: int) -> int:
        """Return the time of a message in nanoseconds, from its header or of its arrival.

        A header whose time is 0 counts as having none.
        """
        if not self.is_captured:
            return received
        stamp = message.header.stamp
        return int(stamp.sec) * 1_000_000_000 + int(stamp.nanosec) or received


class Observation(Entry, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A topic that a policy observes: numbers in its messages, or images.

    Attributes:
        image: ``color``, ``mono`` or ``depth`` if messages are images; None for numbers.
        height: The height of the images in pixels.
        width: Their width.
        infinity: The number that replaces positive infinity, such as that of a scan's beam without
            a return; by default, a message with infinities is refused. Entries with this number are
            not interpolated by default.
    """

    image: Literal["color", "mono", "depth"] | None = None
    height: int = 0
    width: int = 0
    infinity: float | None = None

    def check_fields(self) -> None:
        """Raise ValueError for a path that the message lacks, or an image without a size."""
        if self.image is None:
            if self.type in IMAGES:
                raise ValueError("image: none; use color, mono or depth for images")
            super().check_fields()
            if self.infinity is not None and not abs(self.infinity) <= float(
                np.finfo(np.float32).max
            ):
                raise ValueError(f"infinity: {self.infinity:g}; use a finite number")
        elif self.infinity is not None:
            raise ValueError("infinity: images have none; leave it out")
        elif self.type not in IMAGES:
            raise ValueError(f"image: {self.type} is not an image; use {' or '.join(IMAGES)}")
        elif self.fields or self.names:
            raise ValueError("fields: images have none; leave them out")
        elif self.resample == "interpolate":
            raise ValueError("resample: images are not interpolated; use hold")
        elif not (0 < self.height <= 16_384 and 0 < self.width <= 16_384):
            raise ValueError(
                f"height: {self.height} by width {self.width}; give the size of the images in "
                "pixels, such as 480 by 640"
            )

    @property
    def is_interpolated(self) -> bool:
        """Whether a value between two messages is interpolated."""
        return self.resample == "interpolate" or (
            not self.resample and self.image is None and self.infinity is None and self.has_floats
        )

    def replace_infinities(self, numbers: npt.NDArray[np.float64]) -> None:
        """Put `infinity` in place of positive infinity, if the contract has it."""
        if self.infinity is not None:
            numbers[numbers == math.inf] = self.infinity

    @property
    def shape(self) -> tuple[int, ...]:
        """The shape of a value: for an image, rows, columns and, in colour, three channels."""
        if self.image is None:
            return (len(self.paths),)
        size = (self.height, self.width)
        return (*size, 3) if self.image == "color" else size

    def value(self, message: Any) -> Array:
        """Return the value of a message: float32 numbers, or the pixels of an image.

        Images are uint8, in colour red, green and blue; depths are float32 metres, where 0 and
        NaN are unknown.

        Raises:
            MessageError: the message lacks a number, or is not such an image (a ValueError).
        """
        if self.image is None:
            return super().value(message)
        if self.type == IMAGES[1]:
            message = pictures.decompress(message, (self.width, self.height))
        pixels = pixels_of(message, self.image)
        if pixels.shape != self.shape:
            raise MessageError(
                self.type,
                f"{pixels.shape[1]} by {pixels.shape[0]} pixels; the contract has {self.width} by "
                f"{self.height}",
            )
        return pixels


class Action(Entry, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A topic that a policy commands.

    Attributes:
        lower: The lower limit of each number, or one for all; by default, none.
        upper: The upper limit of each number, or one for all; by default, none.
        stop: What stops the robot: ``zero`` for all numbers, ``hold`` for the last command again,
            or the fields of a message.
        template: The other fields of the message, such as ``{header: {frame_id: base}}``.
        lease_sec: How long after the last command the stop is sent, in seconds.
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
            raise ValueError("lower: greater than upper, or not a number")
        if not (math.isfinite(self.lease_sec) and self.lease_sec > 0):
            raise ValueError(f"lease_sec: {self.lease_sec:g}; use a number of seconds")
        for name, make in (("template", self.zero), ("stop", self.stop_message)):
            try:
                make()
            except (MessageError, KeyError, TypeError, AttributeError) as error:
                raise ValueError(f"{name}: {error}") from None

    @property
    def is_interpolated(self) -> bool:
        """Whether a value between two messages is interpolated."""
        return self.resample == "interpolate"

    @property
    def shape(self) -> tuple[int, ...]:
        """The shape of a value."""
        return (len(self.paths),)

    @property
    def limits(self) -> tuple[Array, Array]:
        """The lower and the upper limit of each number."""
        lower, upper = (
            np.broadcast_to(np.array(limit, np.float64), self.shape)
            for limit in (self.lower, self.upper)
        )
        return lower, upper

    def clamped(self, values: Array) -> tuple[Array, int]:
        """Return the values clamped to the limits, and how many were outside them.

        Raises:
            ContractError: there are too few or too many, or some are not finite (a ValueError).
        """
        given = np.asarray(values, np.float64)
        if given.shape != self.shape or not np.isfinite(given).all():
            raise ContractError(
                self.topic,
                self.feature,
                f"{escaped(str(given)[:200])}; use {len(self.paths)} finite numbers: "
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
            ContractError: there are too few or too many, or some are not finite (a ValueError).
        """
        inside, _ = self.clamped(values)
        return self.stamped(self.filled(inside.tolist()), stamp)

    def zero(self) -> Any:
        """Return the message with zero in all numbers, whatever the limits."""
        return self.filled([0.0] * len(self.paths))

    def stop_message(self, last: Any = None) -> Any:
        """Return the message that stops the robot.

        Args:
            last: The last command, which ``stop: hold`` sends again; without one,
                there is nothing to hold and the result is None.
        """
        if self.stop == "hold":
            return last
        return self.zero() if self.stop == "zero" else from_builtins(self.message_type, self.stop)

    def filled(self, values: list[float]) -> Any:
        """Return a message of the template with values."""
        return filled(self.message_type, self.paths, values, self.template)

    def stamped(self, message: Any, stamp: Any) -> Any:
        """Set the time in the header of a message that has one."""
        if stamp is not None and self.has_header:
            message.header.stamp = stamp
        return message


@lru_cache(1000)
def are_floats(cls: Any, paths: tuple[str, ...]) -> bool:
    """Return whether all numbers at the paths of a message class are floating-point numbers."""
    return all(check_path(cls, path).kind.startswith("float") for path in paths)


def pixels_of(message: Any, kind: str) -> Array:
    """Return the pixels of an Image: uint8 colours or greys, or float32 depths in metres.

    Raises:
        MessageError: its encoding cannot be converted (a ValueError).
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
        problem = f"{message.encoding!r}; use 16UC1 or 32FC1 for depths"
        raise MessageError("sensor_msgs/msg/Image.encoding", problem)
    scale = np.float32(0.001 if pixels.dtype.kind == "u" else 1.0)
    return pixels.astype(np.float32) * scale
