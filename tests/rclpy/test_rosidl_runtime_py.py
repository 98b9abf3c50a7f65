"""`rosidl_runtime_py` and `ament_index_python`, as programs use them."""

from __future__ import annotations

from pathlib import Path

import pytest

import rosidl_runtime_py as runtime
from aionode._packages import use
from ament_index_python import (
    PackageNotFoundError,
    get_package_prefix,
    get_package_share_directory,
    get_packages_with_prefixes,
    get_resource,
    get_resource_types,
    get_resources,
    has_resource,
)
from rosidl_generator_py import action_class, message_class, service_class
from rosidl_runtime_py.utilities import get_action, get_message, get_service

Header = message_class("std_msgs/msg/Header")
Sequences = message_class("test_msgs/msg/UnboundedSequences")
BasicTypes = message_class("test_msgs/msg/BasicTypes")


pytestmark = pytest.mark.usefixtures("installed")


def test_a_message_becomes_yaml() -> None:
    """The output of `ros2 topic echo`."""
    header = Header(frame_id="map")
    header.stamp.sec = 5

    assert runtime.message_to_yaml(header) == "stamp:\n  sec: 5\n  nanosec: 0\nframe_id: map\n"
    flow = runtime.message_to_yaml(header, flow_style=True)
    assert flow == "{stamp: {sec: 5, nanosec: 0}, frame_id: map}\n"


def test_a_message_becomes_a_dictionary() -> None:
    """Numbers are Python's, arrays are lists, bytes are text."""
    message = Sequences(int32_values=[1, 2], byte_values=[b"\xff"], string_values=["a"])

    found = runtime.message_to_ordereddict(message)

    assert found["int32_values"] == [1, 2]
    assert found["byte_values"] == ["\xff"]
    assert next(iter(found)) == "bool_values"
    arrays = runtime.message_to_ordereddict(message_class("test_msgs/msg/Arrays")())
    assert type(arrays["float32_values"][0]) is float


def test_long_values_are_shortened() -> None:
    """`ros2 topic echo` has options for this."""
    message = Sequences(int32_values=[1, 2, 3], string_values=["abcdef"])

    short = runtime.message_to_ordereddict(message, truncate_length=2)
    without = runtime.message_to_ordereddict(message, no_arr=True)
    bounded = runtime.message_to_ordereddict(
        message_class("test_msgs/msg/BoundedSequences")(), no_arr=True
    )
    arrays = runtime.message_to_ordereddict(message_class("test_msgs/msg/Arrays")(), no_arr=True)

    assert short["int32_values"] == [1, 2, "..."]
    assert short["string_values"] == ["ab..."]
    assert without["int32_values"] == "<sequence type: int32, length: 3>"
    assert bounded["string_values"] == "<sequence type: string[3], length: 0>"
    assert arrays["basic_types_values"] == "<array type: test_msgs/msg/BasicTypes[3]>"
    assert runtime.message_to_ordereddict(Header(frame_id="map"), no_str=True)["frame_id"] == (
        "<string length: <3>>"
    )


def test_a_message_becomes_a_line() -> None:
    """`ros2 topic echo --csv`."""
    header = Header(frame_id="map")

    assert runtime.message_to_csv(header) == "0,0,map"
    assert runtime.message_to_csv(Header(frame_id="abc"), truncate_length=2) == "0,0,ab..."


def test_fields_are_set_from_dictionaries() -> None:
    """`ros2 topic pub` and rosbridge build messages this way."""
    message = Sequences()

    runtime.set_message_fields(
        message,
        {"int32_values": [1, 2], "basic_types_values": [{"int8_value": 5}], "alignment_check": "7"},
    )

    assert message.int32_values.tolist() == [1, 2]
    assert message.basic_types_values == [BasicTypes(int8_value=5)]
    assert message.alignment_check == 7
    arrays = message_class("test_msgs/msg/Arrays")()
    runtime.set_message_fields(arrays, {"float32_values": [1, 2, 3]})
    assert arrays.float32_values.tolist() == [1.0, 2.0, 3.0]


def test_times_are_returned_to_be_set_later() -> None:
    """``auto`` and ``now`` stand for the time at which a message is sent."""
    pose = message_class("geometry_msgs/msg/PoseStamped")()
    log = message_class("rcl_interfaces/msg/Log")()
    now = message_class("builtin_interfaces/msg/Time")(sec=9)

    setters = runtime.set_message_fields(pose, {"header": "auto"}, expand_header_auto=True)
    setters += runtime.set_message_fields(log, {"stamp": "now"}, expand_time_now=True)
    for set_time in setters:
        set_time(now)

    assert pose.header.stamp.sec == 9
    assert log.stamp.sec == 9


def test_what_does_not_fit_is_refused() -> None:
    """The errors are those of ROS."""
    with pytest.raises(AttributeError, match="wrong"):
        runtime.set_message_fields(Header(), {"wrong": 1})
    with pytest.raises(TypeError, match="Value '5' is expected to be a dictionary but is a int"):
        runtime.set_message_fields(Header(), 5)  # type: ignore[arg-type]


def test_types_are_found_by_name() -> None:
    """With and without the kind in the middle."""
    assert get_message("std_msgs/String") is message_class("std_msgs/msg/String")
    assert get_service("std_srvs/srv/Trigger") is service_class("std_srvs/srv/Trigger")
    fibonacci = get_action("example_interfaces/Fibonacci")
    assert fibonacci is action_class("example_interfaces/action/Fibonacci")
    with pytest.raises(ValueError, match="Expected the full name of a message"):
        get_message("std_srvs/srv/Trigger")
    with pytest.raises(ModuleNotFoundError):
        get_message("nothing/String")
    with pytest.raises(AttributeError):
        get_message("std_msgs/Nothing")


@pytest.mark.slow
def test_interfaces_are_listed() -> None:
    """Tools use them for completion."""
    assert "msg/String" in runtime.get_interfaces(["std_msgs"])["std_msgs"]
    assert "srv/Trigger" in runtime.get_service_interfaces()["std_srvs"]
    assert "std_srvs" not in runtime.get_message_interfaces()
    assert runtime.get_action_interfaces(["example_interfaces"]) == {
        "example_interfaces": ["action/Fibonacci"]
    }
    with pytest.raises(LookupError, match="Unknown package 'nothing'"):
        runtime.get_interfaces(["nothing"])


def test_installed_packages_are_found(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A colcon workspace is an index of files; programs look for their own data there."""
    index = tmp_path / "share" / "ament_index" / "resource_index" / "packages"
    index.mkdir(parents=True)
    (index / "my_robot").write_text("")
    (tmp_path / "share" / "my_robot" / "msg").mkdir(parents=True)
    (tmp_path / "share" / "my_robot" / "msg" / "Score.msg").write_text("float32 value\n")
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path))

    assert get_package_share_directory("my_robot") == str(tmp_path / "share" / "my_robot")
    assert get_packages_with_prefixes() == {"my_robot": str(tmp_path)}
    assert get_resource_types() == {"packages"}
    path = runtime.get_interface_path("my_robot/msg/Score")
    assert path == str(tmp_path / "share" / "my_robot" / "msg" / "Score.msg")
    with pytest.raises(PackageNotFoundError, match="package 'other' not found, searching"):
        get_package_share_directory("other")
    with pytest.raises(LookupError, match="comes with aionode"):
        runtime.get_interface_path("std_msgs/msg/String")


def test_without_a_prefix_path_resources_are_those_of_the_workspace(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Launch files check whether a package exists, and do without it otherwise."""
    folder = tmp_path / "src" / "my_robot"
    folder.mkdir(parents=True)
    (folder / "package.xml").write_text("<package><name>my_robot</name></package>")
    monkeypatch.delenv("AMENT_PREFIX_PATH", raising=False)
    use(tmp_path)

    assert has_resource("packages", "my_robot") == get_package_prefix("my_robot")
    assert get_resource("packages", "my_robot") == ("", str(folder))
    assert get_resources("packages")["my_robot"] == str(folder)
    assert get_packages_with_prefixes()["my_robot"] == str(folder)
    assert "packages" in get_resource_types()
    assert has_resource("packages", "other") is False
    with pytest.raises(LookupError, match="Could not find the resource 'other'"):
        get_resource("packages", "other")


def test_without_a_prefix_path_a_package_is_not_found(monkeypatch: pytest.MonkeyPatch) -> None:
    """Programs then use another folder; ROS, whose variable is always set, raises the same."""
    monkeypatch.delenv("AMENT_PREFIX_PATH", raising=False)

    with pytest.raises(PackageNotFoundError, match="package 'my_robot' not found, searching"):
        get_package_share_directory("my_robot")
