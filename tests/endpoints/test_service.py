"""Services and clients: answers, errors, cancellation, and missing servers."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Any

import pytest

from aionode._process.concurrency import checkpoint
from aionode.engine.context import Context
from aionode.engine.transport.local import LocalRequest, LocalTransport
from aionode.errors import (
    CallbackSignatureError,
    EntityDestroyedError,
    InvalidServiceNameException,
    MessageError,
    RequestTimeoutError,
    ServiceError,
    ServiceUnavailableError,
)
from aionode.interfaces.example_interfaces.srv import AddTwoInts, SetBool
from aionode.interfaces.std_msgs.msg import String
from aionode.node import Node
from aionode.testing import FaultyTransport, settle
from tests.support.living import living

if TYPE_CHECKING:
    from collections.abc import Callable

Request = AddTwoInts.Request
Response = AddTwoInts.Response


def add(request: Request, response: Response) -> Response:
    """Answer like the tutorial's server."""
    response.sum = request.a + request.b
    return response


class Gate:
    """A handler that waits for a gate, and records how it ended."""

    def __init__(self) -> None:
        self.began: list[int] = []
        self.cancelled: list[int] = []
        self.opened = asyncio.Event()

    async def __call__(self, request: Request, response: Response) -> Response:
        """Answer with `a` when the gate is open."""
        self.began.append(request.a)
        try:
            await self.opened.wait()
        except asyncio.CancelledError:
            self.cancelled.append(request.a)
            raise
        response.sum = request.a
        return response


# Answers


@pytest.mark.parametrize("handler", [add, lambda request: Response(sum=request.a + request.b)])
async def test_a_call_returns_the_response(node: Node, handler: Any) -> None:
    """The handler may take rclpy's two arguments, or one."""
    node.create_service(AddTwoInts, "add", handler)
    client = node.create_client(AddTwoInts, "add")
    assert (await client.call(Request(a=2, b=3))).sum == 5


async def test_a_handler_may_be_a_coroutine_function(node: Node) -> None:
    """It may await anything."""

    async def handler(request: Request, response: Response) -> Response:
        await checkpoint()
        return add(request, response)

    node.create_service(AddTwoInts, "add", handler)
    assert (await node.create_client(AddTwoInts, "add").call(Request(a=2, b=3))).sum == 5


async def test_concurrent_calls_get_their_own_responses(node: Node) -> None:
    """A hundred at once, answered one after the other."""
    node.create_service(AddTwoInts, "add", add)
    client = node.create_client(AddTwoInts, "add")
    answers = await asyncio.gather(*(client.call(Request(a=n, b=0)) for n in range(100)))
    assert [answer.sum for answer in answers] == list(range(100))


async def test_answers_out_of_order_reach_the_right_callers(node: Node) -> None:
    """The first caller may be the last to be answered."""
    gates = {n: asyncio.Event() for n in range(3)}

    async def handler(request: Request) -> Response:
        await gates[request.a].wait()
        return Response(sum=request.a)

    node.create_service(AddTwoInts, "add", handler, concurrent=True)
    client = node.create_client(AddTwoInts, "add")
    async with asyncio.TaskGroup() as tasks:
        calls = [tasks.create_task(client.call(Request(a=n))) for n in range(3)]
        for n in (2, 0, 1):
            gates[n].set()
            await settle()
            assert calls[n].done()
    assert [call.result().sum for call in calls] == [0, 1, 2]


async def test_a_callback_may_call_a_service_of_its_own_node(node: Node) -> None:
    """In rclpy it deadlocks."""
    heard: list[int] = []
    node.create_service(AddTwoInts, "add", add)
    client = node.create_client(AddTwoInts, "add")

    async def on_text(_: String) -> None:
        heard.append((await client.call(Request(a=1, b=1))).sum)

    node.create_subscription(String, "words", on_text)
    node.create_publisher(String, "words", 10).publish(String())
    await settle()
    assert heard == [2]


async def test_a_handler_may_call_another_service(node: Node) -> None:
    """Services may be built on other services."""
    inner = node.create_client(AddTwoInts, "inner")

    async def outer(request: Request) -> Response:
        return await inner.call(request)

    node.create_service(AddTwoInts, "inner", add)
    node.create_service(AddTwoInts, "outer", outer)
    assert (await node.create_client(AddTwoInts, "outer").call(Request(a=2, b=2))).sum == 4


async def test_every_server_of_a_name_answers_and_the_first_counts(
    node: Node, node_factory: Callable[..., Node]
) -> None:
    """As in ROS 2: later answers are ignored."""
    served: list[str] = []

    def answer(name: str) -> Callable[[Request], Response]:
        def handler(request: Request) -> Response:
            served.append(name)
            return Response(sum=len(served))

        return handler

    node.create_service(AddTwoInts, "add", answer("one"))
    node_factory("other").create_service(AddTwoInts, "/add", answer("two"))
    await settle()
    response = await node.create_client(AddTwoInts, "add").call(Request())
    await settle()
    assert response.sum == 1
    assert sorted(served) == ["one", "two"]


async def test_requests_are_snapshots(node: Node) -> None:
    """The caller may change and reuse its object."""
    seen: list[int] = []

    def handler(request: Request) -> Response:
        seen.append(request.a)
        return Response()

    node.create_service(AddTwoInts, "add", handler)
    client = node.create_client(AddTwoInts, "add")
    request = Request(a=1)
    async with asyncio.TaskGroup() as tasks:
        tasks.create_task(client.call(request))
        await checkpoint()
        request.a = 2
    assert seen == [1]


# Without a server


async def test_a_call_without_a_server_ends_by_timeout_and_says_why(node: Node) -> None:
    """Including how many servers were matched."""
    client = node.create_client(AddTwoInts, "add")
    with pytest.raises(RequestTimeoutError, match="/add: no reply in 0 s; no server is matched"):
        await client.call(Request(), timeout_sec=0)


async def test_a_timeout_of_asyncio_says_why_too(
    node: Node, capfd: pytest.CaptureFixture[str]
) -> None:
    """In a note on the exception that interrupted the call, and in the log."""
    client = node.create_client(AddTwoInts, "add")
    with pytest.raises(TimeoutError) as caught:
        async with asyncio.timeout(0):
            await client.call(Request())
    assert isinstance(caught.value.__cause__, asyncio.CancelledError)
    (note,) = caught.value.__cause__.__notes__
    assert "no server is matched" in note


async def test_a_server_that_appears_later_does_not_get_the_old_request(
    node: Node, capfd: pytest.CaptureFixture[str]
) -> None:
    """Services are volatile; the log says that no server is there."""
    served: list[int] = []
    client = node.create_client(AddTwoInts, "add")
    async with asyncio.TaskGroup() as tasks:
        lost = tasks.create_task(client.call(Request(a=1)))
        await settle()

        def serve(request: Request) -> Response:
            served.append(request.a)
            return Response()

        node.create_service(AddTwoInts, "add", serve)
        await client.call(Request(a=2))
        lost.cancel()
    assert served == [2]
    assert "called while no server is matched" in capfd.readouterr().err


async def test_wait_for_service_is_woken_by_the_service(node: Node) -> None:
    """It does not poll."""
    client = node.create_client(AddTwoInts, "add")
    async with asyncio.TaskGroup() as tasks:
        waiting = tasks.create_task(client.wait_for_service())
        await settle()
        assert not waiting.done()
        node.create_service(AddTwoInts, "add", add)
    assert waiting.result() is True
    assert client.service_is_ready()


async def test_wait_for_service_returns_false_after_its_timeout(node: Node) -> None:
    """As in rclpy."""
    client = node.create_client(AddTwoInts, "add")
    assert await client.wait_for_service(timeout_sec=0) is False


async def test_a_service_of_another_type_is_not_ready(node: Node) -> None:
    """It could not understand the request."""
    node.create_service(SetBool, "add", lambda request: SetBool.Response())
    assert not node.create_client(AddTwoInts, "add").service_is_ready()


# Errors


async def test_a_failing_handler_answers_with_its_error(node: Node) -> None:
    """At once, with type and text, and never a hang."""

    def handler(request: Request) -> Response:
        raise ValueError(f"cannot add {request.a}")

    node.create_service(AddTwoInts, "add", handler, on_error="log")
    with pytest.raises(ServiceError, match="/add: ValueError: cannot add 7") as caught:
        await node.create_client(AddTwoInts, "add").call(Request(a=7))
    assert caught.value.error_type == "ValueError"
    assert caught.value.error_text == "cannot add 7"
    assert caught.value.service == "/add"


@pytest.mark.parametrize("concurrent", [False, True])
async def test_a_failing_handler_ends_its_node_after_the_client_was_told(
    context: Context, node: Node, *, concurrent: bool
) -> None:
    """`on_error="raise"` behaves as rclpy does; the client still gets its answer."""

    def handler(request: Request) -> Response:
        raise ValueError("boom")

    server = Node("server", context=context)
    server.create_service(AddTwoInts, "/add", handler, concurrent=concurrent, on_error="raise")
    client = node.create_client(AddTwoInts, "/add")

    async def call() -> None:
        with pytest.raises(ServiceError, match="boom"):
            await client.call(Request())

    async with asyncio.TaskGroup() as tasks:
        tasks.create_task(call())
        with pytest.raises(ExceptionGroup) as caught:
            await server.run()
    assert caught.group_contains(ValueError, match="boom")


@pytest.mark.parametrize("concurrent", [False, True])
async def test_a_server_survives_a_bad_request(
    node: Node, capfd: pytest.CaptureFixture[str], *, concurrent: bool
) -> None:
    """As a web server does: the caller is told, the log has the traceback, the next is served."""

    async def handler(request: Request) -> Response:
        if request.a < 0:
            raise ValueError("only counts")
        return Response(sum=request.a)

    service = node.create_service(AddTwoInts, "add", handler, concurrent=concurrent)
    client = node.create_client(AddTwoInts, "add")

    with pytest.raises(ServiceError, match="only counts"):
        await client.call(Request(a=-1))

    assert (await client.call(Request(a=1))).sum == 1
    assert node.is_running
    assert service.stats.errors == 1
    logged = capfd.readouterr().err
    assert "service /add (callback" in logged
    assert "Traceback" in logged


@pytest.mark.parametrize("answer", [None, "text", SetBool.Response()])
async def test_a_handler_that_returns_something_else_is_an_error(
    node: Node, answer: object
) -> None:
    """Forgetting `return response` is the classic."""
    service = node.create_service(
        AddTwoInts,
        "add",
        lambda request: answer,  # type: ignore[arg-type]  # the mistake
        on_error="log",
    )
    with pytest.raises(ServiceError, match=r"TypeError.*must end with `return response`"):
        await node.create_client(AddTwoInts, "add").call(Request())
    assert service.stats.errors == 1


async def test_a_response_that_does_not_fit_is_an_error(node: Node) -> None:
    """It names the field."""
    node.create_service(AddTwoInts, "add", lambda request: Response(sum=2**63), on_error="log")
    with pytest.raises(ServiceError, match=r"AddTwoInts_Response\.sum"):
        await node.create_client(AddTwoInts, "add").call(Request())


async def test_a_request_of_another_type_is_an_error(node: Node) -> None:
    """Raised where the mistake is made."""
    client = node.create_client(AddTwoInts, "add")
    with pytest.raises(TypeError, match="AddTwoInts_Request"):
        await client.call(SetBool.Request())  # type: ignore[arg-type]  # the mistake


@pytest.mark.parametrize("served", [True, False])
async def test_a_request_that_does_not_fit_is_an_error(node: Node, *, served: bool) -> None:
    """Whether there is a server or not."""
    if served:
        node.create_service(AddTwoInts, "add", add)
    client = node.create_client(AddTwoInts, "add")
    with pytest.raises(MessageError, match=r"AddTwoInts_Request\.a"):
        await client.call(Request(a=2**63))


@pytest.mark.parametrize(
    ("arguments", "error", "text"),
    [
        ((String, "add", add), TypeError, "is not a service class"),
        ((AddTwoInts.Request, "add", add), TypeError, "is not a service class"),
        ((AddTwoInts, "1add", add), InvalidServiceNameException, "must not start with a number"),
        ((AddTwoInts, "add", None), TypeError, "None is not callable"),
        ((AddTwoInts, "add", lambda: None), CallbackSignatureError, "must take (request, resp"),
    ],
)
async def test_a_mistake_in_create_service_is_reported_there(
    node: Node, arguments: tuple[Any, ...], error: type[Exception], text: str
) -> None:
    """Each its own error."""
    with pytest.raises(error) as caught:
        node.create_service(*arguments)
    assert text in str(caught.value)


# Ends


async def test_a_timed_out_call_does_not_disturb_the_next(node: Node) -> None:
    """Its late answer goes nowhere."""
    gate = Gate()
    node.create_service(AddTwoInts, "add", gate, concurrent=True)
    client = node.create_client(AddTwoInts, "add")
    late = asyncio.get_running_loop().create_task(client.call(Request(a=1)))
    await settle()
    late.cancel()
    await settle()

    gate.opened.set()

    assert (await client.call(Request(a=2))).sum == 2
    assert gate.cancelled == []


async def test_a_request_that_was_given_up_before_its_turn_is_not_served(node: Node) -> None:
    """Its client no longer waits for the answer."""
    gate = Gate()
    service = node.create_service(AddTwoInts, "add", gate)
    client = node.create_client(AddTwoInts, "add")
    async with asyncio.TaskGroup() as tasks:
        tasks.create_task(client.call(Request(a=1)))
        given_up = tasks.create_task(client.call(Request(a=2)))
        await settle()
        given_up.cancel()
        await settle()
        gate.opened.set()
    await settle()
    assert gate.began == [1]
    assert (service.stats.received, service.stats.dropped) == (1, 1)


async def test_a_late_reply_does_nothing(manual_clock: Any) -> None:
    """It comes after a timeout, or after a cancellation at the very moment of its arrival."""
    transport = FaultyTransport(LocalTransport(), delay=1.0, clock=manual_clock)
    context = Context(transport=transport)
    async with Node("node", context=context) as node:
        node.create_service(AddTwoInts, "add", add)
        client = node.create_client(AddTwoInts, "add")
        call = asyncio.get_running_loop().create_task(client.call(Request(a=1)))
        await manual_clock.advance(1.5)
        call.cancel()
        with pytest.raises(asyncio.CancelledError):
            await call
        await manual_clock.advance(5.0)

        async with asyncio.TaskGroup() as tasks:
            good = tasks.create_task(client.call(Request(a=2, b=2)))
            await manual_clock.advance(2.0)
        assert good.result().sum == 4


async def test_destroying_a_client_ends_its_calls(node: Node) -> None:
    """Those who wait for them get the reason."""
    node.create_service(AddTwoInts, "add", Gate())
    client = node.create_client(AddTwoInts, "add")
    call = asyncio.get_running_loop().create_task(client.call(Request()))
    await settle()
    client.destroy()
    with pytest.raises(EntityDestroyedError):
        await call
    with pytest.raises(RuntimeError, match="client of /add is destroyed"):
        await client.call(Request())


async def test_destroying_a_client_ends_its_waits(node: Node) -> None:
    """Otherwise the tasks would wait forever."""
    client = node.create_client(AddTwoInts, "add")
    waiting = asyncio.get_running_loop().create_task(client.wait_for_service())
    await settle()
    client.destroy()
    with pytest.raises(EntityDestroyedError):
        await waiting


@pytest.mark.parametrize("concurrent", [False, True])
async def test_a_server_that_goes_away_ends_the_call_at_once(
    context: Context, node: Node, *, concurrent: bool
) -> None:
    """The handler is cancelled, and the client gets an error that says so."""
    gate = Gate()
    client = node.create_client(AddTwoInts, "/add")
    async with Node("server", context=context) as server:
        server.create_service(AddTwoInts, "/add", gate, concurrent=concurrent)
        calls = [
            asyncio.get_running_loop().create_task(client.call(Request(a=n))) for n in range(2)
        ]
        await settle()
    for call in calls:
        with pytest.raises(ServiceUnavailableError, match="/add: the server went away"):
            await call
    assert sorted(gate.cancelled) == sorted(gate.began)


async def test_code_that_handles_a_timeout_handles_a_server_that_goes_away(
    context: Context, node: Node
) -> None:
    """In ROS 2 such a call just times out, and its callers catch the TimeoutError."""
    client = node.create_client(AddTwoInts, "/add")
    async with Node("server", context=context) as server:
        service = server.create_service(AddTwoInts, "/add", Gate())
        asyncio.get_running_loop().call_soon(service.destroy)
        with pytest.raises(TimeoutError):
            async with asyncio.timeout(60):
                await client.call(Request())
    assert client.stats.errors == 1


async def test_with_one_of_two_servers_gone_the_other_still_answers(
    context: Context, node: Node
) -> None:
    """The call fails only when no server is left."""
    gate = Gate()
    node.create_service(AddTwoInts, "/add", gate)
    client = node.create_client(AddTwoInts, "/add")
    async with Node("server", context=context) as server:
        server.create_service(AddTwoInts, "/add", Gate())
        call = asyncio.get_running_loop().create_task(client.call(Request(a=5)))
        await settle()
    assert not call.done()
    gate.opened.set()
    assert (await call).sum == 5


async def test_a_handler_that_destroys_its_server_does_not_answer(
    context: Context, node: Node
) -> None:
    """The server that could answer is gone."""
    client = node.create_client(AddTwoInts, "/add")
    async with Node("server", context=context) as server:

        async def handler(request: Request, response: Response) -> Response:
            service.destroy()
            await checkpoint()
            return response

        service = server.create_service(AddTwoInts, "/add", handler)
        with pytest.raises(ServiceUnavailableError):
            await client.call(Request())


async def test_nothing_is_left_of_calls_that_ended(node: Node) -> None:
    """A client that calls for days must not grow."""
    gate = Gate()
    node.create_service(AddTwoInts, "add", gate, concurrent=True)
    client = node.create_client(AddTwoInts, "add")
    await settle()
    futures, requests = living(asyncio.Future), living(LocalRequest)
    calls = [asyncio.get_running_loop().create_task(client.call(Request(a=n))) for n in range(100)]
    await settle()
    for call in calls[:50]:
        call.cancel()
    gate.opened.set()
    await asyncio.gather(*calls, return_exceptions=True)
    await settle()
    calls.clear()
    del call
    assert living(asyncio.Future) < futures + 10
    assert living(LocalRequest) <= requests


async def test_too_many_waiting_requests_are_refused_with_an_error(
    node: Node, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    """The queue is bounded, and no client waits for an answer that cannot come.

    The log of the server says it, too, but not for each request.
    """
    monkeypatch.setattr("aionode.endpoints.service.WAITING_REQUESTS", 2)
    gate = Gate()
    service = node.create_service(AddTwoInts, "add", gate)
    client = node.create_client(AddTwoInts, "add")
    waiting = [asyncio.get_running_loop().create_task(client.call(Request(a=n))) for n in range(9)]
    await settle()
    gate.opened.set()
    with pytest.raises(ServiceError, match="2 requests are waiting already"):
        await waiting[3]
    ends = await asyncio.gather(*waiting, return_exceptions=True)
    refused = sum(isinstance(end, ServiceError) for end in ends)
    assert service.stats.dropped == refused > 1
    (said,) = [text for text in caplog.messages if "refused a request" in text]
    assert "service /add" in said


async def test_a_destroyed_client_says_so(node: Node) -> None:
    """Even while waiting for its service."""
    client = node.create_client(AddTwoInts, "add")
    client.destroy()
    with pytest.raises(EntityDestroyedError):
        await client.wait_for_service()


async def test_a_client_counts_calls_and_errors(node: Node) -> None:
    """A dashboard shows these."""
    node.create_service(AddTwoInts, "add", add)
    client = node.create_client(AddTwoInts, "add")
    await client.call(Request())
    assert (client.stats.calls, client.stats.errors, client.stats.run_time.count) == (1, 0, 1)
    assert "calls=1 errors=0" in repr(client)
