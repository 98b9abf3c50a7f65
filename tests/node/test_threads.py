"""Tests of nodes and entities that are created and destroyed outside the event loop's thread."""

from __future__ import annotations

import asyncio
import threading
from collections.abc import Callable
from typing import Any

import pytest

from aionode import ActionClient, ActionServer, Context, Node
from aionode.errors import EntityDestroyedError, InvalidTopicNameException
from aionode.interfaces.example_interfaces.action import Fibonacci
from aionode.interfaces.example_interfaces.srv import AddTwoInts
from aionode.interfaces.std_msgs.msg import String
from aionode.testing import local_context, settle
from tests.support.arrivals import gid_of


def add(request: AddTwoInts.Request) -> AddTwoInts.Response:
    """Answer a request."""
    return AddTwoInts.Response(sum=request.a + request.b)


CREATORS: dict[str, Callable[[Node], Any]] = {
    "publisher": lambda node: node.create_publisher(String, "/chatter", 10),
    "subscription": lambda node: node.create_subscription(String, "/chatter", lambda msg: None),
    "service": lambda node: node.create_service(AddTwoInts, "/add", add),
    "client": lambda node: node.create_client(AddTwoInts, "/add"),
    "timer": lambda node: node.create_timer(1.0, lambda: None),
    "rate": lambda node: node.create_rate(10.0),
    "action server": lambda node: ActionServer(node, Fibonacci, "/count", lambda goal: None),
    "action client": lambda node: ActionClient(node, Fibonacci, "/count"),
}


@pytest.mark.parametrize("kind", CREATORS)
async def test_every_entity_can_be_created_and_destroyed_in_another_thread(
    node: Node, kind: str
) -> None:
    """The loop's thread does the work, so asyncio's debug mode finds nothing to report."""
    before = repr(node)  # with the number of entities

    entity = await asyncio.to_thread(CREATORS[kind], node)

    assert not entity.destroyed
    assert repr(node) != before
    await asyncio.to_thread(entity.destroy)
    assert entity.destroyed
    assert repr(node) == before


async def test_an_entity_created_in_another_thread_works(node: Node) -> None:
    """Its callback is called in the loop's thread, like any other."""
    heard = []

    def create() -> None:
        node.create_subscription(
            String, "/chatter", lambda msg: heard.append((msg.data, threading.get_ident()))
        )
        node.create_publisher(String, "/chatter", 10).publish(String(data="hello"))

    await asyncio.to_thread(create)
    await settle()

    assert heard == [("hello", threading.get_ident())]


async def test_destroy_methods_of_the_node_work_in_another_thread(node: Node) -> None:
    """They call `Entity.destroy`."""
    publisher = node.create_publisher(String, "/chatter", 10)

    assert await asyncio.to_thread(node.destroy_publisher, publisher)

    assert publisher not in node.publishers


async def test_errors_of_a_creation_come_out_in_the_thread_that_asked(node: Node) -> None:
    """The loop is not affected by them."""
    with pytest.raises(InvalidTopicNameException):
        await asyncio.to_thread(node.create_publisher, String, "not a name", 10)
    node.destroy_node()
    with pytest.raises(EntityDestroyedError):
        await asyncio.to_thread(node.create_publisher, String, "/chatter", 10)


async def test_a_node_can_be_created_in_another_thread_while_its_context_runs(
    context: Context,
) -> None:
    """Its built-in services are entities, too."""

    class Listener(Node):
        def __init__(self) -> None:
            super().__init__("listener", context=context)
            self.heard: list[str] = []
            self.create_subscription(String, "/chatter", lambda msg: self.heard.append(msg.data))

    listener = await asyncio.to_thread(Listener)

    async with listener:
        listener.create_publisher(String, "/chatter", 10).publish(String(data="hello"))
        await settle()
        assert listener.heard == ["hello"]


async def test_many_threads_create_entities_at_once(node: Node) -> None:
    """Each gets its own, and none is lost."""
    created = await asyncio.gather(
        *(
            asyncio.to_thread(node.create_publisher, String, f"/topic_{number}", 10)
            for number in range(20)
        )
    )

    assert {each.topic_name for each in created} <= {each.topic_name for each in node.publishers}
    assert len({gid_of(node, f"/topic_{number}") for number in range(20)}) == 20


async def test_a_content_filter_can_be_set_in_another_thread(node: Node) -> None:
    """It takes effect between two messages."""
    subscription = node.create_subscription(String, "/words")
    publisher = node.create_publisher(String, "/words", 10)

    await asyncio.to_thread(subscription.set_content_filter, "data = 'b'", [])
    for word in ("a", "b"):
        publisher.publish(String(data=word))

    assert (await subscription.receive()).data == "b"


def test_no_thread_waits_for_a_loop_that_stands_still() -> None:
    """A program may run its loop in steps, and do something else in between."""
    loop = asyncio.new_event_loop()
    node = Node("node", context=local_context())
    loop.run_until_complete(node.__aenter__())
    heard: list[str] = []

    def work() -> None:
        node.create_subscription(String, "/chatter", lambda msg: heard.append(msg.data))
        publisher = node.create_publisher(String, "/chatter", 10)
        publisher.publish(String(data="hello"))
        publisher.destroy()

    thread = threading.Thread(target=work)
    thread.start()
    thread.join(10)

    assert not thread.is_alive()
    loop.run_until_complete(settle())
    assert heard == ["hello"]
    loop.run_until_complete(node.__aexit__(None, None, None))
    loop.close()
