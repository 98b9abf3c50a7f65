"""The shipped types against the definitions that rosbags carries for each distribution.

`docs/interfaces.md` says what differs; these tests keep that true.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest
from rosbags.typesys import Stores, get_typestore

from aionode._distribution import DEFAULT
from aionode.engine.wire.typehash import type_hash
from aionode.idl import define
from aionode.idl._build import Builder
from aionode.idl._distribution_differences import differences
from aionode.idl._parser import parse
from aionode.interfaces import OF_ROS, get_interface, get_message
from aionode.message import FieldType, fields, type_name
from tests.support.strategies import shipped_types

OTHER: dict[str, set[str]] = {
    "ROS2_HUMBLE": {
        "rosbag2_interfaces/msg/ReadSplitEvent",
        "rosbag2_interfaces/msg/WriteSplitEvent",
        "sensor_msgs/msg/Range",
    },
    "ROS2_JAZZY": set(),
    "ROS2_KILTED": set(),
    "ROS2_LYRICAL": {"lifecycle_msgs/msg/TransitionEvent"},
}
NEW_IN_LYRICAL = {
    "rosbag2_interfaces/msg/MessagesLostEvent",
    "rosbag2_interfaces/msg/MessagesLostEventTopicStat",
}
MISSING: dict[str, set[str]] = {
    "ROS2_HUMBLE": {
        *NEW_IN_LYRICAL,
        "geometry_msgs/msg/PolygonInstance",
        "geometry_msgs/msg/PolygonInstanceStamped",
        "geometry_msgs/msg/VelocityStamped",
        "nav_msgs/msg/Goals",
        "rcl_interfaces/msg/LoggerLevel",
        "rcl_interfaces/msg/SetLoggerLevelsResult",
        "service_msgs/msg/ServiceEventInfo",
        "type_description_interfaces/msg/Field",
        "type_description_interfaces/msg/FieldType",
        "type_description_interfaces/msg/IndividualTypeDescription",
        "type_description_interfaces/msg/KeyValue",
        "type_description_interfaces/msg/TypeDescription",
        "type_description_interfaces/msg/TypeSource",
    },
    "ROS2_JAZZY": {"nav_msgs/msg/Goals", *NEW_IN_LYRICAL},
    "ROS2_KILTED": NEW_IN_LYRICAL,
    "ROS2_LYRICAL": {
        "actionlib_msgs/msg/GoalID",
        "actionlib_msgs/msg/GoalStatus",
        "actionlib_msgs/msg/GoalStatusArray",
        "geometry_msgs/msg/Pose2D",
    },
}
CARRIED = OF_ROS - {"example_interfaces", "test_msgs", "turtlesim"}
"""The packages of ROS that rosbags has."""


VECTORS = Path(__file__).parents[1] / "vectors" / "interface_hashes.json"
HASHES: dict[str, dict[str, str]] = json.loads(VECTORS.read_text(encoding="utf-8"))
"""For each distribution, how the hashes of types begin after RIHS01_."""


def classes_of(distribution: str) -> dict[str, Any]:
    """Return the classes of the types that differ in a distribution."""
    texts = {name: parse(name, text) for name, text in differences(distribution).items()}
    builder = Builder(texts, reuse=False)
    return {name: builder.build(name) for name in texts}


def as_text(node: Any) -> str:
    """Return a type as rosbags describes it, in the form of `str(FieldType)`."""
    kind, content = int(node[0]), node[1]
    if kind == 1:
        return f"{content[0]}<={content[1]}" if content[1] else str(content[0])
    if kind == 2:
        return str(content).replace("/msg/", "/")
    one, size = as_text(content[0]), content[1]
    return f"{one}[{size}]" if kind == 3 else f"{one}[<={size}]" if size else f"{one}[]"


def described(name: str) -> list[tuple[str, str]]:
    """Return the fields of a shipped message; constants are not on the wire and not in the hash."""
    found = [(field.name, str(field.type)) for field in fields(get_message(name))]
    return found or [("structure_needs_at_least_one_member", "uint8")]


@pytest.mark.parametrize("distribution", list(OTHER))
def test_the_shipped_types_are_those_of_ros_but_for_what_the_docs_say(distribution: str) -> None:
    """An independent source: other people's copy of ROS's definitions."""
    known = get_typestore(Stores[distribution]).fielddefs
    names = [n for n in shipped_types() if "/msg/" in n and n.split("/")[0] in CARRIED]
    missing = {name for name in names if name not in known}
    differing = set()
    for name in set(names) - missing:
        if described(name) != [(field, as_text(node)) for field, node in known[name][1]]:
            differing.add(name)

    assert differing == OTHER[distribution]
    assert missing == MISSING[distribution]


@pytest.mark.parametrize(
    ("typename", "begin"),
    [
        ("msg/MessagesLostEvent", "b4a1d6322a232c78"),
        ("srv/Resume", "fb0ccd61ead193e5"),
        ("srv/SplitBagfile", "d2ffa105574b58e4"),
        ("srv/Stop", "850e221df0c7d2a5"),
    ],
)
def test_what_lyrical_has_changed_for_bags_has_its_hashes(typename: str, begin: str) -> None:
    """They are those of code that rosidl has generated from Lyrical's rosbag2."""
    name = f"rosbag2_interfaces/{typename}"
    text = differences("lyrical").get(name)
    found: Any = get_interface(name) if text is None else define(name, text)

    assert type_hash(found).startswith(f"RIHS01_{begin}")


@pytest.mark.parametrize("distribution", ["humble", "jazzy", "kilted", "lyrical", "rolling"])
def test_each_difference_is_one_to_what_is_shipped(distribution: str) -> None:
    """The shipped types are those of one distribution, which so has no differences."""
    shipped = shipped_types()
    for name, cls in classes_of(distribution).items():
        assert name not in shipped or type_hash(cls) != type_hash(shipped[name]), name
    assert not differences(DEFAULT)


@pytest.mark.parametrize("distribution", [DEFAULT, "humble", "kilted", "lyrical"])
def test_types_of_robots_have_the_hashes_that_rosidl_computes(distribution: str) -> None:
    """Those of rosidl's own code for the definitions in the packages' repositories.

    For other distributions they are those of the types that differ, of what contains one of them,
    and of the types that only they have.
    """
    known = HASHES[distribution]
    classes = shipped_types() if distribution == DEFAULT else classes_of(distribution)

    assert known == {name: type_hash(cls)[7:23] for name, cls in classes.items() if name in known}
    if distribution != DEFAULT:
        assert set(classes) == set(known)


def test_the_distribution_that_is_named_brings_its_goals_and_new_types() -> None:
    """A program for Nav2 of Lyrical, on a machine without ROS."""
    program = (
        "from aionode.interfaces.nav2_msgs.msg import TrackingFeedback\n"
        "from aionode.interfaces.nav2_msgs.srv import AddShapes\n"
        "from aionode.interfaces.nav2_msgs.action import FollowPath\n"
        "from aionode.message import fields\n"
        "print(fields(AddShapes.Request)[0].type.nested.__name__)\n"
        "print(fields(FollowPath.Feedback)[-1].type)"
    )
    environ = {**os.environ, "ROS_DISTRO": "lyrical"}

    done = subprocess.run(
        [sys.executable, "-W", "error", "-c", program],
        env=environ,
        capture_output=True,
        text=True,
        check=False,
    )

    assert done.stdout.split() == ["CircleObject", "nav2_msgs/TrackingFeedback"], done.stderr


@pytest.mark.parametrize(
    ("typename", "begin"),
    [
        ("msg/MultiNested", "9ee9cbfb17c2df99"),
        ("msg/Strings", "eee55533636293ac"),
        ("msg/WStrings", "5a2c8ddb20546000"),
        ("srv/Arrays", "ae66e13b3ad1520b"),
    ],
)
def test_the_test_interfaces_have_the_hashes_of_their_definitions(
    typename: str, begin: str
) -> None:
    """They are those of rcl_interfaces; a node of ROS with another definition is not heard."""
    assert type_hash(get_interface(f"test_msgs/{typename}")).startswith(f"RIHS01_{begin}")


def test_a_type_is_written_as_in_a_definition() -> None:
    """The comparison above relies on this."""
    header = get_message("std_msgs/msg/Header")

    assert type_name(header) == "std_msgs/msg/Header"
    assert str(FieldType("message", header, None, "array", 3)) == "std_msgs/Header[3]"
    assert str(FieldType("string", None, 10, "bounded", 2)) == "string<=10[<=2]"
