"""Graph queries of `ros2 topic`, and the QoS profiles that its options select."""

from __future__ import annotations

import copy
from argparse import ArgumentParser, ArgumentTypeError
from typing import Any

import rclpy
from rclpy.clock import Clock
from rclpy.duration import Duration
from rclpy.exceptions import InvalidTopicNameException
from rclpy.expand_topic_name import expand_topic_name
from rclpy.qos import (
    DurabilityPolicy,
    HistoryPolicy,
    LivelinessPolicy,
    QoSPresetProfiles,
    QoSProfile,
    ReliabilityPolicy,
)
from rclpy.topic_or_service_is_hidden import topic_or_service_is_hidden
from rclpy.validate_full_topic_name import validate_full_topic_name
from ros2cli.node.strategy import NodeStrategy
from rosidl_runtime_py import get_message_interfaces
from rosidl_runtime_py.utilities import get_message

__all__ = [
    "TopicNameCompleter",
    "add_qos_arguments",
    "get_msg_class",
    "get_topic_names",
    "get_topic_names_and_types",
    "message_type_completer",
    "positive_float",
    "positive_int",
    "profile_configure_short_keys",
    "qos_profile_from_short_keys",
]

PERIOD_SEC = 0.1


def positive_int(string: str) -> int:
    """Return an argument as a positive integer.

    Raises:
        ArgumentTypeError: It is not one.
    """
    try:
        value = int(string)
    except ValueError:
        value = -1
    if value <= 0:
        raise ArgumentTypeError("value must be a positive integer")
    return value


def positive_float(inval: str) -> float:
    """Return an argument as a positive number.

    Raises:
        ArgumentTypeError: It is not one.
    """
    try:
        value = float(inval)
    except ValueError:
        raise ArgumentTypeError("Expects a floating point number") from None
    if value <= 0.0:
        raise ArgumentTypeError("Value must be positive")
    return value


def get_topic_names_and_types(
    *, node: Any, include_hidden_topics: bool = False
) -> list[tuple[str, list[str]]]:
    """Return the topics of the graph, with their types."""
    return [
        (name, types)
        for name, types in node.get_topic_names_and_types()
        if include_hidden_topics or not topic_or_service_is_hidden(name)
    ]


def get_topic_names(*, node: Any, include_hidden_topics: bool = False) -> list[str]:
    """Return the topics of the graph."""
    found = get_topic_names_and_types(node=node, include_hidden_topics=include_hidden_topics)
    return [name for name, _ in found]


def get_msg_class(
    node: Any, topic: str, blocking: bool = False, include_hidden_topics: bool = False
) -> Any:
    """Return the class of a topic's messages, with a warning if the topic does not exist.

    Args:
        node: The node that searches.
        topic: The topic, relative to the node.
        blocking: Whether to wait for the topic.
        include_hidden_topics: Whether the topic may be hidden.

    Returns:
        The class; None if the topic does not exist.

    Raises:
        RuntimeError: The name is invalid, the topic has several types, or its type is unknown.
    """
    found = class_of(node, topic, include_hidden_topics)
    if found is None:
        print(f"WARNING: topic [{topic}] does not appear to be published yet")
    clock = Clock()
    while found is None and blocking and rclpy.ok():
        clock.sleep_for(Duration(seconds=PERIOD_SEC))
        found = class_of(node, topic, include_hidden_topics)
    return found


def class_of(node: Any, topic: str, include_hidden_topics: bool) -> Any:
    """Return the class of a topic's messages; None if the topic does not exist."""
    try:
        name = expand_topic_name(topic, node.get_name(), node.get_namespace())
        validate_full_topic_name(name)
    except (ValueError, InvalidTopicNameException) as error:
        raise RuntimeError(error) from error
    topics = dict(get_topic_names_and_types(node=node, include_hidden_topics=include_hidden_topics))
    types = topics.get(name)
    if not types:
        return None
    if len(types) > 1:
        raise RuntimeError(
            f"Cannot echo topic '{topic}', as it contains more than one type: [{', '.join(types)}]"
        )
    try:
        return get_message(types[0])
    except (AttributeError, ModuleNotFoundError, ValueError) as error:
        raise RuntimeError(f"The message type '{types[0]}' is invalid") from error


def message_type_completer(**kwargs: Any) -> list[str]:
    """Return the types of messages."""
    found = get_message_interfaces()
    return [f"{package}/{name}" for package in sorted(found) for name in sorted(found[package])]


class TopicNameCompleter:
    """Returns the names of topics, for an argument of a command.

    Args:
        include_hidden_topics_key: The argument that says whether to include hidden ones.
    """

    def __init__(self, *, include_hidden_topics_key: str | None = None) -> None:
        self.include_hidden_topics_key = include_hidden_topics_key

    def __call__(self, prefix: str, parsed_args: Any, **kwargs: Any) -> list[str]:
        """Return the names."""
        hidden = getattr(parsed_args, self.include_hidden_topics_key or "", False)
        with NodeStrategy(parsed_args) as node:
            return get_topic_names(node=node, include_hidden_topics=hidden)


def profile_configure_short_keys(
    profile: Any = None,
    reliability: str | None = None,
    durability: str | None = None,
    depth: int | None = None,
    history: str | None = None,
    liveliness: str | None = None,
    liveliness_lease_duration_s: float | None = None,
) -> None:
    """Set the given policies of a profile, by their short names."""
    for name, policy, value in (
        ("history", HistoryPolicy, history),
        ("durability", DurabilityPolicy, durability),
        ("reliability", ReliabilityPolicy, reliability),
        ("liveliness", LivelinessPolicy, liveliness),
    ):
        if value:
            setattr(profile, name, policy.get_from_short_key(value))
    if liveliness_lease_duration_s and liveliness_lease_duration_s >= 0:
        profile.liveliness_lease_duration = Duration(seconds=liveliness_lease_duration_s)
    if depth and depth >= 0:
        profile.depth = depth
    elif profile.durability == DurabilityPolicy.TRANSIENT_LOCAL and profile.depth == 0:
        profile.depth = 1


def qos_profile_from_short_keys(
    preset_profile: str,
    reliability: str | None = None,
    durability: str | None = None,
    depth: int | None = None,
    history: str | None = None,
    liveliness: str | None = None,
    liveliness_lease_duration_s: float | None = None,
) -> QoSProfile:
    """Return a preset profile with the given policies."""
    profile: Any = copy.copy(QoSPresetProfiles.get_from_short_key(preset_profile))
    profile_configure_short_keys(
        profile, reliability, durability, depth, history, liveliness, liveliness_lease_duration_s
    )
    return profile  # type: ignore[no-any-return]  # the presets are enum members


def add_qos_arguments(
    parser: ArgumentParser, subscribe_or_publish: str, default_profile_str: str
) -> None:
    """Add the arguments that `qos_profile_from_short_keys` takes.

    Args:
        parser: Their parser.
        subscribe_or_publish: What the profile is for: a verb.
        default_profile_str: The preset that is the default.
    """
    parser.add_argument(
        "--qos-profile",
        choices=QoSPresetProfiles.short_keys(),
        default=default_profile_str,
        help=f"Quality of service preset profile to {subscribe_or_publish} with"
        f" (default: {default_profile_str})",
    )
    parser.add_argument(
        "--qos-depth",
        metavar="N",
        type=int,
        help=f"Queue size setting to {subscribe_or_publish} with",
    )
    for name, policy in (
        ("history", HistoryPolicy),
        ("reliability", ReliabilityPolicy),
        ("durability", DurabilityPolicy),
        ("liveliness", LivelinessPolicy),
    ):
        parser.add_argument(
            f"--qos-{name}",
            choices=policy.short_keys(),
            help=f"Quality of service {name} setting to {subscribe_or_publish} with",
        )
    parser.add_argument(
        "--qos-liveliness-lease-duration-seconds",
        type=float,
        help=f"Quality of service liveliness lease duration to {subscribe_or_publish} with",
    )
