"""The classes that aionode creates, compared with those of ROS itself.

They are compared where a Python with ROS's packages is known: AIONODE_REAL_RCLPY is its path, and
``pip install 'ros-rclpy[fastrtps]' ros-std-msgs ros-test-msgs`` makes one.
"""

from __future__ import annotations

import json
import os
import subprocess
from pathlib import Path
from typing import Any

import pytest

from rosidl_generator_py import interface_class
from tests.support import rosidl_report
from tests.support.strategies import shipped_types

REAL = os.environ.get("AIONODE_REAL_RCLPY")

pytestmark = [
    pytest.mark.skipif(REAL is None, reason="AIONODE_REAL_RCLPY, a Python with ROS, is not set"),
    pytest.mark.timeout(120),
]

ZERO_DEFAULTS = {
    "geometry_msgs/msg/Quaternion",
    "rcl_interfaces/msg/ParameterDescriptor",
    "type_description_interfaces/msg/FieldType",
}
"""Definitions that write the zero of a type as a default, which aionode does not remember.

Their classes lack constants such as ``X__DEFAULT``; the value of the field is the same.
"""


@pytest.fixture(scope="module")
def real() -> dict[str, Any]:
    """The properties and behaviour of ROS's own classes."""
    program = Path(rosidl_report.__file__)
    assert REAL is not None
    done = subprocess.run(
        [REAL, "-W", "ignore", str(program)],
        input="\n".join(shipped_types()),
        capture_output=True,
        text=True,
        check=False,
        env={**os.environ, "PYTHONPATH": ""},
    )
    assert done.returncode == 0, done.stderr
    found: dict[str, Any] = json.loads(done.stdout)
    return found


@pytest.mark.filterwarnings("ignore")
def test_classes_are_those_of_ros(real: dict[str, Any]) -> None:
    """Names, types, constants, error texts, and the conversion of any value: all the same."""
    names = [name for name in shipped_types() if any(key.startswith(name) for key in real)]
    own = rosidl_report.report({name: interface_class(name) for name in names})
    own = json.loads(json.dumps(own, default=str))

    differences = [
        f"{name}: {what}\n  ROS     {value}\n  aionode {own[name].get(what)}"
        for name, described in real.items()
        for what, value in described.items()
        if own[name].get(what) != value and not known(name, what)
    ]

    assert names
    assert differences == []


def known(name: str, what: str) -> bool:
    """Return whether a difference is a known one."""
    about_defaults = {"constants", "constants set", "attributes", "metaclass has"}
    return name in ZERO_DEFAULTS and what in about_defaults
