"""Tests of the contract for programs that build on aionode: own loop, clock and transport."""

from __future__ import annotations

import asyncio
import threading
from typing import TYPE_CHECKING, Any, Self, TypeVar

from aionode import Context, Node
from aionode.engine.transport.base import Registration, Requester, Transport, Writer
from aionode.engine.transport.local import LocalTransport
from aionode.interfaces.std_msgs.msg import String
from aionode.testing import local_context

if TYPE_CHECKING:
    from collections.abc import Coroutine
    from concurrent.futures import Future
    from types import TracebackType

    from aionode.engine.transport.base import Reader, Serve
    from aionode.graph import EndpointInfo, Graph, NodeInfo

T = TypeVar("T")


class BackgroundLoop:
    """An event loop in a thread of its own, for programs that are not async."""

    def __init__(self) -> None:
        self.loop = asyncio.new_event_loop()
        self._thread = threading.Thread(target=self.loop.run_forever, name="nodes")

    def __enter__(self) -> Self:
        self._thread.start()
        return self

    def __exit__(
        self,
        exc_type: type[BaseException] | None,
        exc: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self.loop.call_soon_threadsafe(self.loop.stop)
        self._thread.join()
        self.loop.close()

    def submit(self, work: Coroutine[Any, Any, T]) -> Future[T]:
        """Run a coroutine in the loop; the future's `result` waits for it in this thread."""
        return asyncio.run_coroutine_threadsafe(work, self.loop)


class CountingTransport(Transport):
    """Passes everything on to another transport, and counts the publishers."""

    def __init__(self, inner: Transport) -> None:
        self.inner = inner
        self.writers = 0

    async def open(self, graph: Graph) -> None:
        """Connect."""
        await self.inner.open(graph)

    async def close(self) -> None:
        """Disconnect."""
        await self.inner.close()

    def create_node(self, node: NodeInfo) -> Registration:
        """Announce a node."""
        return self.inner.create_node(node)

    def create_writer(self, endpoint: EndpointInfo, msg_type: type[Any]) -> Writer:
        """Announce a publisher."""
        self.writers += 1
        return self.inner.create_writer(endpoint, msg_type)

    def create_reader(
        self, endpoint: EndpointInfo, msg_type: type[Any], reader: Reader
    ) -> Registration:
        """Announce a subscription."""
        return self.inner.create_reader(endpoint, msg_type, reader)

    def create_server(self, endpoint: EndpointInfo, srv_type: Any, serve: Serve) -> Registration:
        """Announce a service server."""
        return self.inner.create_server(endpoint, srv_type, serve)

    def create_requester(self, endpoint: EndpointInfo, srv_type: Any) -> Requester:
        """Announce a client."""
        return self.inner.create_requester(endpoint, srv_type)


def test_a_program_that_is_not_async_runs_nodes_in_a_background_loop() -> None:
    """A blocking API on top of aionode needs only public names."""
    texts: list[str] = []
    heard = threading.Event()

    def on_text(msg: String) -> None:
        texts.append(msg.data)
        heard.set()

    async def run_and_tell() -> str:
        await node.run()
        return (await node.ended()).reason

    node = Node("node", context=local_context())
    node.create_subscription(String, "/chatter", on_text)
    publisher = node.create_publisher(String, "/chatter", 10)
    with BackgroundLoop() as background:
        end = background.submit(run_and_tell())
        publisher.publish(String(data="hi"))
        assert heard.wait(50)
        node.destroy_node()
        assert end.result(50) == "destroyed"

    assert texts == ["hi"]


async def test_a_transport_of_a_program_carries_its_messages() -> None:
    """The contract is `aionode.transport.base`; a context takes any object that fulfils it."""
    transport = CountingTransport(LocalTransport())
    context = Context(transport=transport)
    async with Node("node", context=context, enable_rosout=False) as node:
        before = transport.writers
        texts = node.create_subscription(String, "/chatter")
        node.create_publisher(String, "/chatter", 10).publish(String(data="hi"))

        assert (await anext(texts)).data == "hi"
        assert transport.writers == before + 1
        assert context.transports == (transport,)
