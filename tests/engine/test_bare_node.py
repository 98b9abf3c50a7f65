"""Nodes without callbacks, for other APIs on top of aionode."""

from __future__ import annotations

import asyncio
import subprocess
import sys
import threading
from typing import TYPE_CHECKING, Any

import pytest

from aionode import Context, Node
from aionode.clock import Duration
from aionode.engine.bare_node import BareNode
from aionode.engine.transport.base import SampleInfo
from aionode.engine.wire import cdr
from aionode.errors import (
    EntityDestroyedError,
    InterfaceNotFoundError,
    QueueFullError,
    ServiceError,
)
from aionode.interfaces.example_interfaces.srv import AddTwoInts
from aionode.interfaces.std_msgs.msg import String
from aionode.message import Message, serialized
from aionode.qos import KEEP_ALL_DEPTH, DurabilityPolicy, HistoryPolicy, QoSProfile

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.engine.transport.base import Request
    from aionode.graph import EndpointInfo

TEN = QoSProfile(depth=10)


class Kept:
    """A reader that keeps what it receives, and the threads in which it was received."""

    raw = False
    endpoint: EndpointInfo

    def __init__(self, limit: int = KEEP_ALL_DEPTH) -> None:
        self.messages: list[Any] = []
        self.infos: list[SampleInfo] = []
        self.threads: list[int] = []
        self.alive: list[bytes] = []
        self.limit = limit

    def deliver(
        self,
        msg: Any,
        gid: bytes,
        sequence: int,
        source_ns: int,
        inline_deadline_ns: int = 0,
        arrived_ns: int = 0,
    ) -> None:
        """Keep a message."""
        self.messages.append(msg)
        self.infos.append(SampleInfo(gid, sequence, source_ns))
        self.threads.append(threading.get_ident())

    def note_alive(self, gid: bytes) -> None:
        """Record which publishers are alive."""
        self.alive.append(gid)

    def reject(self, error: Exception) -> None:
        """Do nothing: no message is rejected here."""

    @property
    def waiting(self) -> int:
        """Return 0: nothing waits."""
        return 0

    def has_room(self) -> bool:
        """Return whether the limit has not been reached."""
        return len(self.messages) < self.limit

    async def wait_for_room(self) -> None:
        """Do nothing: nobody waits here."""

    def when_room(self, callback: Callable[[], None]) -> None:
        """Do nothing: nobody waits here."""


@pytest.fixture
def context() -> Context:
    """Return a context without a network."""
    return Context(transport="local")


async def test_a_bare_node_and_its_endpoints_are_in_the_graph(context: Context) -> None:
    """Other nodes see them like those of any node, until they are destroyed."""
    async with context:
        node = BareNode(context, "bare", "/robot")
        publisher = node.create_publisher(String, "/robot/words", TEN)
        reader = Kept()
        subscription = node.create_subscription(String, "/robot/words", TEN, reader)

        assert [each.fully_qualified_name for each in context.graph.nodes()] == ["/robot/bare"]
        assert publisher.matched() == [subscription.endpoint] == [reader.endpoint]

        subscription.destroy()
        subscription.destroy()
        assert publisher.matched() == []

        node.destroy_node()
        node.destroy_node()
        assert context.graph.nodes() == []
        with pytest.raises(EntityDestroyedError, match="create publisher"):
            node.create_publisher(String, "/robot/words", TEN)


async def test_the_end_of_the_context_destroys_bare_nodes(context: Context) -> None:
    """They belong to the context, as all nodes do."""
    async with context:
        BareNode(context, "bare")

    assert context.graph.nodes() == []


class Words(Message, typename="foreign/msg/Words", by_name=False):
    """A message class found only by its description, as if it came from another process."""

    text: str = "none"


@pytest.mark.parametrize("kind", [Words, serialized(Words)])
async def test_a_bare_node_describes_the_types_of_its_endpoints(
    kind: Any, context: Context
) -> None:
    """No other process may know the types. The types of a destroyed endpoint are not described."""
    async with context, Node("curious", context=context) as curious:
        node = BareNode(context, "bare", "/robot")
        node.describe_types()
        publisher = node.create_publisher(kind, "/words", TEN)

        found = await curious.find_type("foreign/msg/Words")
        assert found is not Words
        assert found().text == "none"

        publisher.destroy()
        with pytest.raises(InterfaceNotFoundError):
            await curious.find_type("foreign/msg/Words")


async def test_a_bare_node_of_humble_describes_nothing() -> None:
    """Humble has neither the service nor its type."""
    async with Context(transport="local", ros_distro="humble") as context:
        BareNode(context, "bare").describe_types()
        assert context.graph.endpoints() == []


async def test_serialized_and_typed_endpoints_hear_each_other(context: Context) -> None:
    """Programs with message classes of their own talk to nodes of aionode in one context."""
    async with context, Node("typed", context=context) as typed:
        node = BareNode(context, "bare")
        words = serialized(String)
        reader = Kept()
        node.create_subscription(words, "/words", TEN, reader)
        publisher = node.create_publisher(words, "/words", TEN)
        subscription = typed.create_subscription(String, "/words")

        typed.create_publisher(String, "/words", 10).publish(String(data="typed"))
        publisher.publish(words(cdr.encode(String(data="bare"))), 17)

        assert [cdr.decode(String, each.data).data for each in reader.messages] == ["typed", "bare"]
        assert reader.infos[1].source_ns == 17
        assert [(await subscription.receive()).data for _ in range(2)] == ["typed", "bare"]


async def test_messages_to_this_context_are_delivered_in_the_thread_that_publishes(
    context: Context,
) -> None:
    """An API with its own threads does not have to wait for the event loop within one process."""
    async with context:
        node = BareNode(context, "bare")
        reader = Kept()
        node.create_subscription(String, "/words", TEN, reader)
        publisher = node.create_publisher(String, "/words", TEN)
        results: list[Any] = []

        def publish() -> None:
            results.append(publisher.publish_here(String(data="here"), 1))
            results.append(threading.get_ident())

        worker = threading.Thread(target=publish)
        worker.start()
        await asyncio.to_thread(worker.join)

        assert [each.data for each in reader.messages] == ["here"]
        assert reader.threads == results[1:]
        assert results[0] == 0  # there are no other subscriptions


async def test_late_subscriptions_get_what_a_transient_local_publisher_has_kept(
    context: Context,
) -> None:
    """The history belongs to the transport, not to the API above."""
    latched = QoSProfile(depth=2, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    async with context:
        node = BareNode(context, "bare")
        publisher = node.create_publisher(String, "/words", latched)
        for text in ("a", "b", "c"):
            publisher.publish_here(String(data=text), 1)
        reader = Kept()

        node.create_subscription(String, "/words", latched, reader)

        assert [each.data for each in reader.messages] == ["b", "c"]


async def test_a_full_keep_all_reader_makes_publishing_fail(context: Context) -> None:
    """No message is dropped silently, and publishing does not block."""
    keep_all = QoSProfile(history=HistoryPolicy.KEEP_ALL)
    async with context:
        node = BareNode(context, "bare")
        reader = Kept(limit=1)
        node.create_subscription(String, "/words", keep_all, reader)
        publisher = node.create_publisher(String, "/words", keep_all)
        publisher.publish(String(), 1)

        with pytest.raises(QueueFullError):
            publisher.publish(String(), 1)

        assert publisher.published == len(reader.messages) == 1


async def test_a_publisher_says_that_it_is_alive(context: Context) -> None:
    """The API above, which has the callbacks, implements the liveliness policies."""
    async with context:
        node = BareNode(context, "bare")
        reader = Kept()
        node.create_subscription(String, "/words", TEN, reader)
        publisher = node.create_publisher(String, "/words", TEN)

        publisher.assert_liveliness()

        assert reader.alive == [publisher.endpoint.gid]


async def test_a_publisher_keeps_no_message_longer_than_its_lifespan(context: Context) -> None:
    """Expired messages kept for late subscriptions would only waste memory."""
    profile = TEN.replace(depth=100, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    async with context:
        node = BareNode(context, "bare")
        limited = profile.replace(lifespan=Duration(seconds=1))
        publisher = node.create_publisher(String, "/words", limited)
        for number in range(5):
            publisher.publish(String(data=str(number)), (number + 1) * 600_000_000)
        reader = Kept()
        node.create_subscription(String, "/words", profile, reader)
        assert [message.data for message in reader.messages] == ["3", "4"]


class Answers:
    """Collects the outcomes of calls."""

    def __init__(self) -> None:
        self.replies: list[Any] = []
        self.errors: list[ServiceError | None] = []


async def test_a_call_is_answered_once(context: Context) -> None:
    """The first answer counts. The server may answer at any time."""
    async with context:
        node = BareNode(context, "bare")
        requests: list[Request] = []
        node.create_server(AddTwoInts, "/add", TEN, lambda request, _=0: requests.append(request))
        client = node.create_client(AddTwoInts, "/add", TEN)
        answers = Answers()

        client.send(AddTwoInts.Request(a=1, b=2), 5, answers.replies.append, answers.errors.append)
        (request,) = requests
        assert (request.message.a, request.sample_info.sequence) == (1, client.calls)
        request.reply(AddTwoInts.Response(sum=3))
        request.reply(AddTwoInts.Response(sum=4))

        assert ([each.sum for each in answers.replies], answers.errors) == ([3], [])


async def test_a_failed_and_a_dropped_request_are_told_apart(context: Context) -> None:
    """An API above may turn one into an exception and the other into a wait."""
    async with context:
        node = BareNode(context, "bare")
        requests: list[Request] = []
        node.create_server(AddTwoInts, "/add", TEN, lambda request, _=0: requests.append(request))
        client = node.create_client(AddTwoInts, "/add", TEN)
        answers = Answers()
        for _ in range(3):
            client.send(AddTwoInts.Request(), 5, answers.replies.append, answers.errors.append)

        requests[0].fail("KeyError", "broken")
        requests[1].drop()

        assert isinstance(answers.errors[0], ServiceError)
        assert answers.errors[1:] == [None]


async def test_a_cancelled_call_is_forgotten(context: Context) -> None:
    """A late answer must not reach a caller that has already given up."""
    async with context:
        node = BareNode(context, "bare")
        requests: list[Request] = []
        node.create_server(AddTwoInts, "/add", TEN, lambda request, _=0: requests.append(request))
        client = node.create_client(AddTwoInts, "/add", TEN)
        answers = Answers()

        client.send(AddTwoInts.Request(), 5, answers.replies.append, answers.errors.append).cancel()
        requests[0].reply(AddTwoInts.Response(sum=3))

        assert requests[0].cancelled
        assert (answers.replies, answers.errors) == ([], [])


async def test_without_a_server_nothing_is_called(context: Context) -> None:
    """No server could answer; the program decides how long to wait for one."""
    async with context:
        client = BareNode(context, "bare").create_client(AddTwoInts, "/add", TEN)
        answers = Answers()

        call = client.send(AddTwoInts.Request(), 5, answers.replies.append, answers.errors.append)

        assert (client.servers, call.open) == (0, 0)
        assert (answers.replies, answers.errors) == ([], [])


LOADING = """
import asyncio, sys
from aionode.bare_node import BareNode
from aionode.interfaces.rcl_interfaces.srv import SetParameters
from aionode.message import serialized
from aionode.qos import qos_profile_services_default as profile
from aionode.testing import local_context

async def main():
    async with local_context() as context:
        node = BareNode(context, "bare")
        for kind, loaded in ((serialized(SetParameters), False), (SetParameters, True)):
            node.create_server(kind, "/set", profile, print)
            assert ("numpy" in sys.modules) is loaded

asyncio.run(main())
"""


@pytest.mark.processes
def test_numpy_is_there_before_a_request_needs_it() -> None:
    """Without it, requests have memoryviews in place of arrays; encoded ones have neither."""
    subprocess.run([sys.executable, "-c", LOADING], check=True)  # the text is here
