"""Classes that users inherit from leave them their names: none of ours is hidden by a subclass."""

from __future__ import annotations

import asyncio
import re
from typing import Any

from aionode import Context, Node, Supervisor
from aionode.interfaces.std_msgs.msg import String
from aionode.lifecycle import LifecycleNode
from aionode.tf import Buffer, TransformListener

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
