"""Finding interfaces by their ROS name."""

from __future__ import annotations

import importlib
import pkgutil
import subprocess
import sys

import pytest

import aionode.interfaces
from aionode.engine.wire.typehash import type_hash
from aionode.errors import InterfaceNotFoundError
from aionode.interfaces import (
    get_action,
    get_interface,
    get_message,
    get_service,
    interface_names,
    shipped_packages,
)
from aionode.interfaces.example_interfaces.action import Fibonacci
from aionode.interfaces.example_interfaces.srv import AddTwoInts
from aionode.interfaces.rcl_interfaces.msg import Log
from aionode.interfaces.std_msgs.msg import String
from aionode.message import type_name
from tests.support.strategies import shipped_types


def test_an_interface_is_found_by_its_name() -> None:
    """The name that topics, services and actions are listed with."""
    assert get_interface("std_msgs/msg/String") is String
    assert get_interface("example_interfaces/srv/AddTwoInts") is AddTwoInts
    assert get_interface("example_interfaces/action/Fibonacci") is Fibonacci


def test_the_kind_may_be_left_out() -> None:
    """As in ``std_msgs/String``, which people type."""
    assert get_interface("std_msgs/String") is String
    assert get_interface("example_interfaces/AddTwoInts") is AddTwoInts


def test_the_kind_can_be_asked_for() -> None:
    """With the functions that rosidl_runtime_py has."""
    assert get_message("std_msgs/msg/String") is String
    assert get_service("example_interfaces/srv/AddTwoInts") is AddTwoInts
    assert get_action("example_interfaces/action/Fibonacci") is Fibonacci
    with pytest.raises(InterfaceNotFoundError, match="AddTwoInts: not a message"):
        get_message("example_interfaces/srv/AddTwoInts")


@pytest.mark.parametrize(
    ("name", "suggestions"),
    [
        ("std_msgs/msg/Strin", ("std_msgs/msg/String",)),
        ("std_msg/msg/String", ("std_msgs/msg/String",)),
        ("AddTwoInts", ("example_interfaces/srv/AddTwoInts",)),
        ("std_msgs/srv/String", ("std_msgs/msg/String",)),
        ("xyz/msg/Abc", ()),
        ("a/b/c/d", ()),
        ("", ()),
        ("os/path/join", ()),
        ("../msg/String", ()),
    ],
)
def test_an_unknown_name_suggests_what_is_close(name: str, suggestions: tuple[str, ...]) -> None:
    """Most are slips of the finger."""
    with pytest.raises(InterfaceNotFoundError) as caught:
        get_interface(name)

    assert caught.value.name == name
    assert caught.value.suggestions[: len(suggestions)] == suggestions
    if not suggestions:
        assert "names look like std_msgs/msg/String" in str(caught.value)


def test_all_packages_of_ros_are_there() -> None:
    """109 packages, 1697 types."""
    assert len(shipped_packages()) == 109
    assert len(shipped_types()) == 1697
    assert interface_names("std_srvs") == (
        "std_srvs/srv/Empty",
        "std_srvs/srv/SetBool",
        "std_srvs/srv/Trigger",
    )


@pytest.mark.parametrize(
    ("name", "beginning"),
    [
        ("ackermann_msgs/msg/AckermannDriveStamped", "48ca7612a08d"),
        ("geographic_msgs/srv/GetGeoPath", "e0c1a08df29c"),
        ("turtlesim/action/RotateAbsolute", "08ba6dd83d97"),
        ("vision_msgs/msg/Detection3DArray", "793f5eab9595"),
    ],
)
def test_types_of_packages_beside_the_standard_ones_meet_those_of_ros(
    name: str, beginning: str
) -> None:
    """Their hashes are those of the definitions of ROS; one wrong field gives another hash."""
    assert type_hash(get_interface(name)).startswith(f"RIHS01_{beginning}")


def test_every_module_lists_its_types() -> None:
    """`from aionode.interfaces.std_msgs.msg import *` gives types and nothing else."""
    for info in pkgutil.walk_packages(aionode.interfaces.__path__, "aionode.interfaces."):
        module = importlib.import_module(info.name)
        if not info.ispkg:
            package, kind = info.name.split(".")[-2:]
            names = [type_name(getattr(module, name)) for name in module.__all__]
            assert names == [f"{package}/{kind}/{name}" for name in module.__all__]


def test_every_type_says_what_it_is_for() -> None:
    """The docstring is more than the name."""
    for name in shipped_types():
        text = get_interface(name).__doc__
        assert text is not None
        assert len(text) > len(name.split("/")[2]) + 1, name


def test_constants_are_those_of_rclpy() -> None:
    """A byte constant is bytes, a number a number."""
    assert Log.WARN == 30
    assert get_message("diagnostic_msgs/msg/DiagnosticStatus").STALE == b"\x03"


NAMES_WITHOUT_CLASSES = """
import sys
from aionode import interfaces

names = interfaces.interface_names()
loaded = [name for name in sys.modules if name.startswith("aionode.interfaces.nav")]
found = {
    f"{package}/{kind}/{name}"
    for package in interfaces.shipped_packages()
    for kind in interfaces.KINDS
    for name in interfaces.types_of(package, kind)
}
print([name for name in loaded if name.count(".") > 2], len(names) > 1000, found == set(names))
"""


@pytest.mark.slow
@pytest.mark.processes
def test_the_names_of_types_are_known_before_their_classes_are() -> None:
    """A list of all names, and the completion of one, shall not make a thousand classes."""
    done = subprocess.run(
        [sys.executable, "-c", NAMES_WITHOUT_CLASSES], capture_output=True, text=True, check=True
    )

    assert done.stdout == "[] True True\n"
