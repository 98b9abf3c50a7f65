"""Classes that users inherit from leave them their names: none of ours is hidden by a subclass."""

from __future__ import annotations

import asyncio
import importlib
import json
import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

import aionode.rclpy
from aionode import Context, Node, Supervisor
from aionode.interfaces.std_msgs.msg import String
from aionode.lifecycle import LifecycleNode
from aionode.tf import Buffer, TransformListener

if TYPE_CHECKING:
    from collections.abc import Iterable

RCLPY: dict[str, list[str]] = json.loads(
    (Path(__file__).parent / "rclpy/free_names.json").read_text(encoding="utf-8")
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
NATIVE_NAMES = (
    "_abandon",
    "_add_entity",
    "_affinity",
    "_callbacks",
    "_clock",
    "_destroy",
    "_entities",
    "_info",
    "_leave",
    "_logger",
    "_parameter_store",
    "_resolve",
    "_running",
    "_tasks",
)
"""Names that were ours once, and that robots have."""

MANGLED = re.compile(r"_[A-Za-z]\w*?__\w")


def own_names(cls: type, instance: object) -> set[str]:
    """Return the names with one underscore of a class and its instance that are not mangled."""
    bases = [base for base in cls.__mro__ if base.__module__.partition(".")[0] != "typing"]
    names = {name for base in bases[:-1] for name in vars(base)} | set(vars(instance))
    return {name for name in names if name[0] == "_" and name[1] != "_" and not MANGLED.match(name)}


async def test_native_classes_leave_names_with_one_underscore_to_users() -> None:
    """A robot with a method of its own named `_add` or `_clock` runs."""
    node, other = Node("a", context=Context(transport="local")), Context(transport="local")
    listener = TransformListener(Buffer(node), node)
    found = {
        cls.__name__: own_names(cls, instance)
        for cls, instance in (
            (Node, node),
            (LifecycleNode, LifecycleNode("b", context=other)),
            (Supervisor, Supervisor(lambda: Node("c"))),
            (TransformListener, listener),
        )
    }
    found["Message"] = {name for name in dir(String) if name[0] == "_" and name[1] != "_"}

    assert {name: names for name, names in found.items() if names} == {}


@pytest.fixture
def rclpy() -> Iterable[Any]:
    """The rclpy of aionode, initialised."""
    aionode.rclpy.install()
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


async def test_a_native_node_works_whatever_methods_of_its_own_it_has() -> None:
    """The same for nodes of asyncio."""

    def mine(self: object, *_: object) -> None:
        raise AssertionError("aionode called a method of the robot's own")

    names = NATIVE_NAMES
    robot: Any = type("Robot", (Node,), dict.fromkeys(names, mine))
    heard: asyncio.Queue[String] = asyncio.Queue()
    async with robot("robot", context=Context(transport="local")) as node:
        node.create_subscription(String, "/words", heard.put_nowait)
        node.create_publisher(String, "/words", 10).publish(String(data="hello"))

        assert (await heard.get()).data == "hello"
