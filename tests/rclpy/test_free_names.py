"""Classes of rclpy leave users the names that the real ones leave them."""

from __future__ import annotations

import importlib
import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from tests.test_free_names import own_names

RCLPY: dict[str, list[str]] = json.loads(
    (Path(__file__).parent / "free_names.json").read_text(encoding="utf-8")
)
"""The names with one underscore that classes of rclpy 9.1.2 have, which programs know."""

RCLPY_NAMES = (
    "_add",
    "_add_event_handlers",
    "_call",
    "_destroy",
    "_executor_weakref",
    "_graph_answers",
    "_handle",
    "_infos",
    "_init_parameters",
    "_make_clock",
    "_parameter_store",
    "_remove_event_handlers",
    "_waitables",
)
"""Names that were ours once, and that robots have."""


@pytest.fixture
def rclpy(installed: None) -> Iterator[Any]:  # a fixture
    """The rclpy of aionode, initialised."""
    module: Any = importlib.import_module("rclpy")
    module.init()
    yield module
    module.shutdown()


CLASSES = (
    ("rclpy.node", "Node", ("free",)),
    ("rclpy.lifecycle", "LifecycleNode", ("free",)),
    ("rclpy.executors", "SingleThreadedExecutor", ()),
    ("rclpy.executors", "MultiThreadedExecutor", ()),
)


@pytest.mark.parametrize(("module", "name", "arguments"), CLASSES)
@pytest.mark.usefixtures("rclpy")
def test_classes_of_rclpy_take_no_names_that_the_real_ones_leave_free(
    module: str, name: str, arguments: tuple[str, ...]
) -> None:
    """A node with methods of its own such as `_init_parameters` is what most robots have."""
    cls = getattr(importlib.import_module(module), name)

    assert own_names(cls, cls(*arguments)) - set(RCLPY[name]) == set()


@pytest.mark.usefixtures("rclpy")
def test_a_node_works_whatever_methods_of_its_own_it_has() -> None:
    """Each of these names was one of ours, and such a robot failed in its constructor."""

    def mine(self: object, *_: object) -> None:
        raise AssertionError("aionode called a method of the robot's own")

    names = RCLPY_NAMES
    robot = type(
        "Robot", (importlib.import_module("rclpy.node").Node,), dict.fromkeys(names, mine)
    )("robot")
    heard: list[str] = []
    words = importlib.import_module("std_msgs.msg").String
    robot.create_subscription(words, "/words", lambda msg: heard.append(msg.data), 10)
    publisher = robot.create_publisher(words, "/words", 10)
    robot.declare_parameter("speed", 1.0)

    publisher.publish(words(data="hello"))
    importlib.import_module("rclpy").spin_once(robot, timeout_sec=10)
    robot.destroy_node()

    assert heard == ["hello"]
