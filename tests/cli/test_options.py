"""Options that several commands share, and the names that the shell is offered."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from aionode import DurabilityPolicy, HistoryPolicy, Node, ReliabilityPolicy
from aionode.cli._nouns.topic.echo import qos_from
from aionode.cli._support.completion import names_of
from aionode.interfaces.example_interfaces.srv import AddTwoInts
from aionode.interfaces.std_msgs.msg import String
from aionode.qos import QoSPresetProfiles, qos_profile_sensor_data

NOTHING: dict[str, Any] = {
    f"qos_{name}": None
    for name in (
        "profile",
        "depth",
        "history",
        "reliability",
        "durability",
        "liveliness",
        "liveliness_lease_duration_seconds",
    )
}


def test_without_options_there_is_no_profile() -> None:
    """The verb then chooses according to the publishers' offers."""
    options = {**NOTHING, "other": 1}

    assert qos_from("default", options) is None
    assert options == {"other": 1}


def test_one_option_changes_the_preset_in_one_place() -> None:
    """The preset itself stays unchanged for the next command."""
    profile = qos_from("sensor_data", {**NOTHING, "qos_reliability": "reliable"})

    assert profile == qos_profile_sensor_data.replace(reliability=ReliabilityPolicy.RELIABLE)
    assert qos_profile_sensor_data.reliability is ReliabilityPolicy.BEST_EFFORT


def test_all_options_make_a_profile() -> None:
    """Click does not distinguish upper and lower case."""
    profile = qos_from(
        "default",
        {
            "qos_profile": "services_default",
            "qos_depth": 3,
            "qos_history": "keep_all",
            "qos_reliability": "best_effort",
            "qos_durability": "transient_local",
            "qos_liveliness": "manual_by_topic",
            "qos_liveliness_lease_duration_seconds": 1.5,
        },
    )

    assert profile is not None
    assert (profile.history, profile.depth) == (HistoryPolicy.KEEP_ALL, 3)
    assert profile.durability is DurabilityPolicy.TRANSIENT_LOCAL
    assert profile.liveliness_lease_duration.nanoseconds == 1_500_000_000


def test_a_history_for_late_subscriptions_holds_at_least_one_message() -> None:
    """As in ros2: system_default has no depth of its own."""
    profile = qos_from(
        "default",
        {**NOTHING, "qos_profile": "system_default", "qos_durability": "transient_local"},
    )

    assert profile is not None
    assert profile.depth == 1
    assert QoSPresetProfiles.get_from_short_key("system_default").depth == 0


@pytest.mark.parametrize(
    ("what", "names"),
    [
        ("node", ["/robot"]),
        ("topic", ["/chatter"]),
        ("service", ["/add", "/robot/get_type_description"]),
        ("action", []),
    ],
)
async def test_the_shell_is_offered_existing_names(
    what: str, names: list[str], tool: Node, node_factory: Callable[..., Node]
) -> None:
    """Hidden names are not offered; they can still be typed."""
    robot = node_factory("robot", enable_rosout=False, start_parameter_services=False)
    robot.create_publisher(String, "/chatter", 1)
    robot.create_publisher(String, "/_hidden", 1)
    robot.create_service(AddTwoInts, "/add", lambda request, response: response)

    offered = [name for name in names_of(tool, what) if name != "/parameter_events"]

    assert offered == names
