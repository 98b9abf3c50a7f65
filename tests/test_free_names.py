"""Classes that users inherit from leave them their names: none of ours is hidden by a subclass."""

from __future__ import annotations

import ast
import asyncio
import importlib
import inspect
import re
import textwrap
from typing import Any

import pytest

from aionode import Context, Node
from aionode.interfaces.geometry_msgs.msg import TransformStamped
from aionode.interfaces.std_msgs.msg import Header, String
from aionode.rclpy._finder import SUPPLIED
from aionode.tf import Buffer, StaticTransformBroadcaster
from tests.rclpy.list_class_names import names_of

REAL_PRIVATE = {
    name: {"_allFramesAsDot", "_chain", "_frameExists", "_getFrameStrings"}
    for name in ("Buffer", "BufferCore")
}
"""Names of tf2's own, which programs know."""

MANGLED = re.compile(r"_[A-Za-z]\w*?__\w")

NATIVE = {
    "aionode": {"Node"},
    "aionode.supervisor": {"Supervisor"},
    "aionode.lifecycle": {"LifecycleNode", "ManagedEntity", "SimpleManagedEntity"},
    "aionode.tf": {
        "Buffer",
        "BufferClient",
        "BufferCore",
        "BufferServer",
        "StaticTransformBroadcaster",
        "TransformBroadcaster",
        "TransformListener",
    },
    "aionode.message_filters": {
        "ApproximateTimeSynchronizer",
        "Cache",
        "Chain",
        "SimpleFilter",
        "Subscriber",
        "TimeSynchronizer",
    },
}
"""The classes that programs inherit from: others are values, or made by nodes only."""


def written_names(cls: type) -> set[str]:
    """Return the names that a class of aionode defines, or gives to its instances."""
    if cls.__module__.partition(".")[0] not in {"aionode", *SUPPLIED}:
        return set()
    (tree,) = ast.parse(textwrap.dedent(inspect.getsource(cls))).body
    assert isinstance(tree, ast.ClassDef)
    return {*vars(cls), *names_of(tree)}


def own_names(cls: type) -> set[str]:
    """Return the names that a class and its bases take, but for those that Python mangles."""
    names = {name for base in cls.__mro__ for name in written_names(base)}
    return {name for name in names if not name.startswith("__") and not MANGLED.match(name)}


def robots(cls: type, real: set[str] | None = None) -> Any:
    """Return a subclass that has methods of names that a robot may well have.

    Each is one of ours without what Python adds to it, with one underscore, and for a class of ROS,
    whose own names are given, also without: the real one has neither.
    """
    ours = {name for base in cls.__mro__ for name in written_names(base)}
    short = {name.partition("__")[2] for name in ours if MANGLED.match(name)}
    names = {f"_{name}" for name in short} | (set() if real is None else short)
    names -= ours | (real or set())
    assert names
    return type("Mine", (cls,), dict.fromkeys(names, mine))


def mine(*_: object) -> None:
    """Be what a robot has by a name of its own."""
    raise AssertionError("aionode called a method of the robot's own")


@pytest.mark.parametrize("module", NATIVE)
def test_native_classes_leave_names_with_one_underscore_to_users(module: str) -> None:
    """A robot with a method of its own named `_add` or `_clock` runs."""
    classes = {name: getattr(importlib.import_module(module), name) for name in NATIVE[module]}
    taken = {
        name: {each for each in own_names(cls) if each[0] == "_"} - REAL_PRIVATE.get(name, set())
        for name, cls in classes.items()
    }

    assert {name: names for name, names in taken.items() if names} == {}


def test_messages_leave_names_with_one_underscore_to_users() -> None:
    """Subclasses of messages are rare, but there are some."""
    assert [name for name in dir(String) if name[0] == "_" and name[1] != "_"] == []


async def test_a_native_node_works_whatever_methods_of_its_own_it_has() -> None:
    """The same for nodes of asyncio."""
    heard: asyncio.Queue[String] = asyncio.Queue()
    async with robots(Node)("robot", context=Context(transport="local")) as node:
        node.create_subscription(String, "/words", heard.put_nowait)
        node.create_publisher(String, "/words", 10).publish(String(data="hello"))

        assert (await heard.get()).data == "hello"


async def test_a_native_node_works_whatever_a_class_named_node_has_of_its_own() -> None:
    """Python gives `__clock` in a robot's class `Node` the name that it has in any class `Node`."""
    members = {name for base in Node.__mro__[:-1] for name in (*vars(base), *written_names(base))}
    private = {f"_Node__{name.rpartition('__')[2]}" for name in members} | {"_Node__core"}
    cls = type("Node", (Node,), dict.fromkeys(private - {"_Node__"}, mine))

    async with cls("robot", context=Context(transport="local")) as node:
        assert node.is_running


async def test_a_native_buffer_works_whatever_methods_of_its_own_it_has() -> None:
    """The same for buffers, and what waits for their transforms."""
    async with Node("robot", context=Context(transport="local")) as node:
        buffer = robots(Buffer)(node)
        robots(StaticTransformBroadcaster)(node).sendTransform(
            TransformStamped(header=Header(frame_id="a"), child_frame_id="b")
        )
        found = await buffer.wait_for_transform("a", "b")

        assert found.child_frame_id == "b"
