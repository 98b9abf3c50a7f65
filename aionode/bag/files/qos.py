"""QoS profiles in bags: YAML, with names since version 9 and numbers before."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

import yaml

from aionode._process.bounded_files import read_file
from aionode._process.bounded_yaml import loaded_yaml
from aionode.clock import CONST_INFINITE_NS, Duration
from aionode.errors import InvalidQoSProfileException
from aionode.qos import (
    DurabilityPolicy,
    HistoryPolicy,
    LivelinessPolicy,
    QoSProfile,
    ReliabilityPolicy,
)

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping
    from os import PathLike

__all__ = [
    "profile_from",
    "profiles_from",
    "profiles_to_yaml",
    "qos_overrides",
    "readable_profiles",
    "to_builtins",
    "yaml_text",
]

FAST_DUMPER: Final = getattr(yaml, "CSafeDumper", yaml.SafeDumper)

POLICIES: Final = {
    "history": HistoryPolicy,
    "reliability": ReliabilityPolicy,
    "durability": DurabilityPolicy,
    "liveliness": LivelinessPolicy,
}
DURATIONS: Final = ("deadline", "lifespan", "liveliness_lease_duration")
SHOWN: Final = 200
"""Maximum number of characters of an invalid profile that an error quotes."""

FOXY_INFINITE: Final = {"sec": 2147483647, "nsec": 4294967295}
"""The infinite duration of DDS, as written by Foxy."""


def to_builtins(qos: QoSProfile) -> dict[str, Any]:
    """Return a profile in the form that rosbag2 writes since version 9."""
    full = qos.resolved()
    durations = {name: seconds_of(getattr(full, name)) for name in DURATIONS}
    return {
        "history": full.history.short_key,
        "depth": full.depth,
        "reliability": full.reliability.short_key,
        "durability": full.durability.short_key,
        "deadline": durations["deadline"],
        "lifespan": durations["lifespan"],
        "liveliness": full.liveliness.short_key,
        "liveliness_lease_duration": durations["liveliness_lease_duration"],
        "avoid_ros_namespace_conventions": full.avoid_ros_namespace_conventions,
    }


def seconds_of(value: Duration) -> dict[str, int]:
    """Return a duration as seconds and nanoseconds."""
    sec, nsec = divmod(value.nanoseconds, 10**9)
    return {"sec": sec, "nsec": nsec}


def profiles_to_yaml(profiles: Iterable[QoSProfile]) -> str:
    """Return profiles as the text of a YAML list; empty if there are none."""
    listed = [to_builtins(qos) for qos in profiles]
    return yaml_text(listed) if listed else ""


def yaml_text(value: object) -> str:
    """Return builtin values as YAML, using libyaml if available, as other threads wait for it."""
    try:
        return str(yaml.dump(value, Dumper=FAST_DUMPER, sort_keys=False))
    except UnicodeEncodeError:  # for a name that is not UTF-8
        return yaml.safe_dump(value, sort_keys=False)


def profiles_from(value: object) -> tuple[QoSProfile, ...]:
    """Return the profiles of a topic from a list or from YAML text.

    Raises:
        ValueError: it does not contain a list of profiles.
    """
    if isinstance(value, str):
        try:
            value = loaded_yaml(value) or []
        except yaml.YAMLError as error:
            raise ValueError(f"offered_qos_profiles is not valid YAML: {error}") from error
    if value is None:
        return ()
    if not isinstance(value, list) or not all(isinstance(item, dict) for item in value):
        raise ValueError("offered_qos_profiles is not a list of profiles")
    return tuple(profile_from(item) for item in value)


def readable_profiles(value: object) -> tuple[tuple[QoSProfile, ...], str]:
    """Return the profiles of a topic, and the reason if they cannot be read."""
    try:
        return profiles_from(value), ""
    except ValueError as error:
        return (), f"its QoS cannot be read: {error}"


def profile_from(item: Mapping[str, Any]) -> QoSProfile:
    """Return the profile described by a mapping; missing policies get their defaults.

    Raises:
        ValueError: a value is not a valid policy, depth or duration.
    """
    fields: dict[str, Any] = {}
    try:
        for name, kind in POLICIES.items():
            if name in item:
                value = item[name]
                fields[name] = kind(value) if isinstance(value, int) else kind[value.upper()]
        for name in DURATIONS:
            if name in item:
                fields[name] = duration_from(item[name])
        depth = int(item.get("depth", 10))
        if depth == 0 and fields.get("history") is HistoryPolicy.KEEP_LAST:
            del fields["history"]  # use the default of the middleware, which depth 0 stands for
        fields["depth"] = depth
        fields["avoid_ros_namespace_conventions"] = bool(
            item.get("avoid_ros_namespace_conventions", False)
        )
        return QoSProfile(**fields)
    except (
        KeyError,
        TypeError,
        ValueError,
        ArithmeticError,
        AttributeError,
        InvalidQoSProfileException,
    ) as error:
        raise ValueError(f"{str(dict(item))[:SHOWN]} is not a QoS profile: {error}") from error


def qos_overrides(path: str | PathLike[str]) -> dict[str, QoSProfile]:
    """Read a YAML file of QoS overrides as used by rosbag2, and return the profiles by topic.

    Args:
        path: The file: policies by topic, with short names such as ``best_effort``.

    Raises:
        OSError: it cannot be read.
        ValueError: it is not such a file.
    """
    try:
        content = loaded_yaml(read_file(path)) or {}
        return {f"/{name.removeprefix('/')}": profile_from(it) for name, it in content.items()}
    except (yaml.YAMLError, AttributeError, TypeError) as error:
        raise ValueError(f"no QoS profiles by topic: {error}") from error


def duration_from(value: Mapping[str, int]) -> Duration:
    """Return a duration; an infinite one becomes the longest that can be represented."""
    if dict(value) == FOXY_INFINITE:
        return Duration(nanoseconds=CONST_INFINITE_NS)
    ns = int(value.get("sec", 0)) * 10**9 + int(value.get("nsec", 0))
    return Duration(nanoseconds=min(ns, CONST_INFINITE_NS))
