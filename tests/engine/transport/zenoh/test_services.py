"""Services between contexts: requests are queries, as in rmw_zenoh_cpp."""

from __future__ import annotations

import asyncio
import json
import logging
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import Any

import pytest
import zenoh  # noqa: TID251  # plays the other participants, without aionode

from aionode.endpoints.client import Client
from aionode.engine.context import Context
from aionode.engine.transport.zenoh._session_state import SessionState
from aionode.engine.transport.zenoh._transport import ZenohTransport
from aionode.engine.transport.zenoh.delivery.request_room import RequestRoom
from aionode.engine.transport.zenoh.endpoints import services
from aionode.engine.transport.zenoh.endpoints.services import error_payload, parse_error
from aionode.engine.wire import _attachment as attachment
from aionode.engine.wire import cdr
from aionode.engine.wire._key_expression import data_key
from aionode.engine.wire.typehash import type_hash
from aionode.errors import RequestTimeoutError, ServiceError, ServiceUnavailableError
from aionode.interfaces import get_service
from aionode.interfaces.example_interfaces.srv import AddTwoInts
from aionode.interfaces.rcl_interfaces.msg import Parameter
from aionode.interfaces.rcl_interfaces.srv import SetParameters
from aionode.message import from_builtins
from tests.support.peers import (
    DOMAIN_ID,
    Collector,
    known,
    quiet_node,
    raw_session,
    ros_value,
    two_contexts,
)
from tests.support.waiting import until

VECTORS: dict[str, Any] = json.loads(
    Path(__file__).parents[3].joinpath("vectors", "vectors.json").read_text()
)
SERVICES: dict[str, dict[str, Any]] = VECTORS["services"]
ADD_TYPE = "example_interfaces/srv/AddTwoInts"
ADD_KEY = data_key(DOMAIN_ID, "/add", ADD_TYPE, type_hash(AddTwoInts))
GID = b"raw client's gid"


def add(request: AddTwoInts.Request, response: AddTwoInts.Response) -> AddTwoInts.Response:
    """Answer as the tutorial does."""
    response.sum = request.a + request.b
    return response


@contextmanager
def raw_server(
    session: zenoh.Session, answer: Callable[[zenoh.Query], None], name: str = "raw"
) -> Iterator[None]:
    """Serve /add without aionode, with the token of a ROS node."""
    queryable = session.declare_queryable(ADD_KEY, answer, complete=True)
    token = session.liveliness().declare_token(
        f"@ros2_lv/{DOMAIN_ID}/{session.zid()}/0/1/SS/%/%/{name}/%add/"
        f"example_interfaces::srv::dds_::AddTwoInts_/{type_hash(AddTwoInts)}/::,10:,:,:,,"
    )
    try:
        yield
    finally:
        token.undeclare()
        queryable.undeclare()


async def raw_reply(
    session: zenoh.Session, key: str, payload: bytes | None, extra: bytes | None
) -> zenoh.Reply:
    """Call as a ROS client does, and again while the way to the server is not known yet."""
    while True:
        replies = Collector()
        session.get(
            key,
            zenoh.handlers.Callback(replies, partial(replies, None)),
            payload=payload,
            attachment=extra,
            target=zenoh.QueryTarget.ALL_COMPLETE,
            consolidation=zenoh.ConsolidationMode.NONE,
            timeout=30,
        )
        reply: zenoh.Reply | None = (await replies.have(1))[0]
        if reply is not None:
            return reply


# Both ends aionode


def state_of(context: Context) -> SessionState:
    """Return the state that all of a context's entities in Zenoh share."""
    transport = context.transports[1]
    assert isinstance(transport, ZenohTransport)
    return transport.session_state


async def test_many_calls_at_once_each_get_their_answer() -> None:
    """Even more than the loop sends at once."""
    async with (
        two_contexts() as (first, second),
        quiet_node("server", first) as server,
        quiet_node("client", second) as node,
    ):
        server.create_service(AddTwoInts, "add", add)
        client = node.create_client(AddTwoInts, "add")
        await client.wait_for_service()
        answers = await asyncio.gather(
            *(client.call(AddTwoInts.Request(a=n, b=1)) for n in range(200))
        )

        assert [answer.sum for answer in answers] == list(range(1, 201))


@pytest.mark.slow
@pytest.mark.one_loop
async def test_ten_thousand_requests_wait_and_more_are_refused_with_the_reason(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The limit was a thousand, and other clients were told that the server had gone."""
    monkeypatch.setenv("AIONODE_LINK", "off")
    waiting, more = 10_000, 25
    async with (
        two_contexts() as (first, second),
        quiet_node("server", first) as server,
        quiet_node("client", second) as node,
    ):
        began, gate = asyncio.Event(), asyncio.Event()

        async def slow(request: AddTwoInts.Request) -> AddTwoInts.Response:
            began.set()
            await gate.wait()
            return AddTwoInts.Response(sum=request.a)

        service = server.create_service(AddTwoInts, "add", slow)
        client = node.create_client(AddTwoInts, "add")
        await client.wait_for_service()
        calls = asyncio.gather(client.call(AddTwoInts.Request()))
        await began.wait()
        refused = asyncio.Event()

        async def call(number: int) -> int | str:
            try:
                return (await client.call(AddTwoInts.Request(a=number))).sum
            except ServiceError as error:
                if service.stats.dropped == more:
                    refused.set()
                return str(error)

        async with asyncio.TaskGroup() as tasks:
            ends = [tasks.create_task(call(number)) for number in range(waiting + more)]
            await refused.wait()
            gate.set()
        await calls
        answers = [end.result() for end in ends]
        errors = [answer for answer in answers if isinstance(answer, str)]
        assert len(errors) == more
        assert all("10000 requests are waiting already" in error for error in errors)
        assert len(set(answers) - set(errors)) == waiting


def test_no_client_takes_all_the_room_of_requests() -> None:
    """Each may have three times the remaining room; a single request always fits."""
    room = RequestRoom(1000)
    requests = [object() for _ in range(3000)]

    assert sum(room.reserve(each, "a", 1) for each in requests[:1000]) == 750
    assert sum(room.reserve(each, "b", 1) for each in requests[1000:2000]) == 188
    assert room.reserve(requests[2000], "c", 50)
    assert not room.reserve(requests[2001], "d", 50)
    for each in requests:
        room.release(each)
    assert room.reserve(requests[0], "a", 5000)


async def test_requests_whose_answers_wait_to_be_sent_are_limited_in_bytes(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A client that reads no answers cannot have any number of its requests kept."""
    async with (
        two_contexts(queue_bytes=65_536) as (first, second),
        Context() as third,
        quiet_node("server", first) as server,
        quiet_node("client", second) as node,
        quiet_node("other", third) as other_node,
    ):
        server.create_service(SetParameters, "set", lambda _: SetParameters.Response())
        senders = state_of(first).peer_senders
        client = node.create_client(SetParameters, "set")
        other = other_node.create_client(SetParameters, "set")
        await client.wait_for_service()
        await other.wait_for_service()
        await server.graph.until(lambda: server.count_clients("/set") == 2)
        unsent: list[Callable[[], None]] = []
        send = senders.send
        monkeypatch.setattr(senders, "send", lambda _to, _size, job: unsent.append(job))
        request = SetParameters.Request(parameters=[Parameter(name="x" * 10_000)])
        calls = [client.call_async(request) for _ in range(20)]
        await until(lambda: len(unsent) + sum(call.done() for call in calls) == 20)

        refused = [call.exception() for call in calls if call.done()]
        assert len(refused) == 15
        assert all("requests are waiting already" in str(each) for each in refused)
        taken = len(unsent)
        other_call = other.call_async(request)  # there is room for the first one of another client
        await until(lambda: len(unsent) + other_call.done() == taken + 1)
        assert not other_call.done()

        monkeypatch.setattr(senders, "send", send)
        for job in unsent:
            job()
        await asyncio.gather(other_call, *calls, return_exceptions=True)
        assert await client.call(request) == SetParameters.Response()


async def test_a_failing_handler_tells_the_client_at_once() -> None:
    """ROS has no way to; between aionode nodes the error travels."""

    def fail(_: AddTwoInts.Request) -> AddTwoInts.Response:
        raise KeyError("no such sum")

    async with (
        two_contexts() as (first, second),
        quiet_node("server", first) as server,
        quiet_node("client", second) as node,
    ):
        server.create_service(AddTwoInts, "add", fail, on_error="log")
        client = node.create_client(AddTwoInts, "add")
        await client.wait_for_service()
        with pytest.raises(ServiceError, match="KeyError: 'no such sum'") as caught:
            await client.call(AddTwoInts.Request())

        assert caught.value.error_type == "KeyError"


async def test_a_server_that_goes_away_ends_the_call_at_once() -> None:
    """No caller waits forever, and the next server is used."""
    async with (
        two_contexts() as (first, second),
        quiet_node("server", first) as server,
        quiet_node("client", second) as node,
    ):
        began = asyncio.Event()

        async def never(_: AddTwoInts.Request) -> AddTwoInts.Response:
            began.set()
            await asyncio.Event().wait()
            raise AssertionError

        service = server.create_service(AddTwoInts, "add", never)
        client = node.create_client(AddTwoInts, "add")
        await client.wait_for_service()
        call = asyncio.gather(client.call(AddTwoInts.Request()))
        await began.wait()
        service.destroy()
        with pytest.raises(ServiceUnavailableError, match="went away before it replied"):
            await call

        server.create_service(AddTwoInts, "add", add)
        await client.wait_for_service()
        assert (await client.call(AddTwoInts.Request(a=1, b=2))).sum == 3


async def test_a_request_that_was_given_up_is_not_served() -> None:
    """The server gets the cancellation, and does no unnecessary work."""
    async with (
        two_contexts() as (first, second),
        quiet_node("server", first) as server,
        quiet_node("client", second) as node,
    ):
        served: list[int] = []
        began, gate = asyncio.Event(), asyncio.Event()

        async def slow(request: AddTwoInts.Request) -> AddTwoInts.Response:
            served.append(request.a)
            began.set()
            await gate.wait()
            return AddTwoInts.Response(sum=request.a)

        server.create_service(AddTwoInts, "add", slow)
        client = node.create_client(AddTwoInts, "add")
        await client.wait_for_service()
        told = asyncio.Event()
        cancellations = state_of(first).cancellations
        cancellations.listen("/other", lambda _gid, _sequence: served.append(0))
        cancellations.listen("/add", lambda _gid, _sequence: told.set())
        busy = asyncio.gather(client.call(AddTwoInts.Request(a=1)))
        await began.wait()
        with pytest.raises(RequestTimeoutError, match="1 matched server"):
            await client.call(AddTwoInts.Request(a=2), timeout_sec=0.05)
        last = asyncio.gather(client.call(AddTwoInts.Request(a=3)))
        await told.wait()
        gate.set()
        await busy
        await last

        assert served == [1, 3]


async def test_a_large_request_and_response_travel_through_a_thread(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """They take more than one packet, and sending them could hold up the loop."""
    from aionode.interfaces.rcl_interfaces.srv import GetParameters

    senders: list[tuple[str, str]] = []

    def note(name: str, send: Callable[..., None]) -> Callable[..., None]:
        def sending(*args: Any) -> None:
            senders.append((name, threading.current_thread().name))
            send(*args)

        return sending

    monkeypatch.setattr(services.ZenohCall, "_get", note("request", services.ZenohCall._get))
    monkeypatch.setattr(services, "answer", note("response", services.answer))
    async with (
        two_contexts() as (first, second),
        quiet_node("server", first) as server,
        quiet_node("client", second) as node,
    ):

        def count(
            request: GetParameters.Request, response: GetParameters.Response
        ) -> GetParameters.Response:
            response.values = [
                type(response.values[0])() if response.values else value_of(name)
                for name in request.names
            ]
            return response

        server.create_service(GetParameters, "get", count)
        client = node.create_client(GetParameters, "get")
        await client.wait_for_service()
        names = ["x" * 1000] * 500
        response = await client.call(GetParameters.Request(names=names))

        assert [len(value.string_value) for value in response.values] == [1000] * 500
        assert set(senders) == {("request", "aionode-peer"), ("response", "aionode-peer")}


def value_of(name: str) -> Any:
    """Return a parameter value that says `name`."""
    from aionode.interfaces.rcl_interfaces.msg import ParameterValue

    return ParameterValue(type=4, string_value=name)


# One end ROS


@pytest.mark.parametrize("half", ["request", "response"])
async def test_requests_and_responses_are_those_of_rmw_zenoh(half: str) -> None:
    """Key, payload and attachment, at both ends."""
    async with quiet_node("node") as node:
        with raw_session() as session:
            for number, (name, golden) in enumerate(SERVICES.items(), 1):
                srv_type: Any = get_service(name)
                request = from_builtins(srv_type.Request, ros_value(golden["request"]["value"]))
                response = from_builtins(srv_type.Response, ros_value(golden["response"]["value"]))
                key = f"{DOMAIN_ID}/srv{number}/{golden['dds_type']}/{golden['rihs01']}"
                if half == "response":
                    heard: list[Any] = []

                    node.create_service(srv_type, f"srv{number}", remembering(heard, response))
                    await known(session, f"@ros2_lv/{DOMAIN_ID}/**/SS/**", number)
                    payload = bytes.fromhex(golden["request"]["cdr"])
                    reply = await raw_reply(session, key, payload, attachment.pack(7, 1, GID))
                    assert reply.ok is not None
                    assert reply.ok.attachment is not None
                    extra = attachment.unpack(reply.ok.attachment.to_bytes())
                    assert reply.ok.payload.to_bytes().hex() == golden["response"]["cdr"]
                    assert str(reply.ok.key_expr) == key
                    assert extra is not None
                    assert (extra.sequence, extra.gid) == (7, GID)
                    assert heard == [request]
                else:
                    queries = Collector()
                    queryable = session.declare_queryable(key, queries, complete=True)
                    token = session.liveliness().declare_token(
                        f"@ros2_lv/{DOMAIN_ID}/{session.zid()}/0/{number}/SS/%/%/raw/%srv{number}/"
                        f"{golden['dds_type']}/{golden['rihs01']}/::,10:,:,:,,"
                    )
                    client: Client[Any, Any] = node.create_client(srv_type, f"srv{number}")
                    await client.wait_for_service()
                    call = asyncio.gather(client.call(request))
                    (query,) = await queries.have(1)
                    extra = attachment.unpack(query.attachment.to_bytes())
                    assert query.payload.to_bytes().hex() == golden["request"]["cdr"]
                    assert extra is not None
                    assert extra.sequence == 1
                    query.reply(
                        key,
                        bytes.fromhex(golden["response"]["cdr"]),
                        attachment=attachment.pack(1, 1, extra.gid),
                    )
                    query.drop()
                    assert list(await call) == [response]
                    token.undeclare()
                    queryable.undeclare()


async def test_the_first_of_several_answers_counts() -> None:
    """With ALL_COMPLETE every server answers."""
    async with quiet_node("client") as node:
        with raw_session() as session:

            def answer(value: int) -> Callable[[zenoh.Query], None]:
                return lambda query: query.reply(
                    ADD_KEY, cdr.encode(AddTwoInts.Response(sum=value)), attachment=None
                )

            with raw_server(session, answer(5), "one"), raw_server(session, answer(5), "two"):
                client = node.create_client(AddTwoInts, "add")
                await client.wait_for_service()
                for _ in range(3):
                    assert (await client.call(AddTwoInts.Request())).sum == 5


async def test_plain_text_in_place_of_an_answer_is_an_error_with_that_text() -> None:
    """As other Zenoh programs send errors."""
    async with quiet_node("client") as node:
        with (
            raw_session() as session,
            raw_server(session, lambda query: query.reply_err(b"out of order")),
        ):
            client = node.create_client(AddTwoInts, "add")
            await client.wait_for_service()
            with pytest.raises(ServiceError, match="/add: out of order"):
                await client.call(AddTwoInts.Request())


async def test_an_answer_that_is_none_is_an_error_and_logged_once(
    caplog: pytest.LogCaptureFixture,
) -> None:
    """The caller must not wait forever for a server with another definition."""
    async with quiet_node("client") as node:
        with (
            raw_session() as session,
            raw_server(session, lambda query: query.reply(ADD_KEY, b"\0\1\0\0\1")),
            caplog.at_level(logging.WARNING, "aionode.transport.zenoh"),
        ):
            client = node.create_client(AddTwoInts, "add")
            await client.wait_for_service()
            for _ in range(3):
                with pytest.raises(ServiceError, match="the response is unreadable"):
                    await client.call(AddTwoInts.Request())

    assert sum("unknown form" in text for text in caplog.messages) == 1


async def test_a_server_that_says_nothing_and_ends_is_unavailable() -> None:
    """A dropped query ends the call."""
    async with quiet_node("client") as node:
        with raw_session() as session, raw_server(session, lambda query: query.drop()):
            client = node.create_client(AddTwoInts, "add")
            await client.wait_for_service()
            with pytest.raises(ServiceUnavailableError):
                await client.call(AddTwoInts.Request())


async def test_a_request_that_found_no_way_is_sent_again() -> None:
    """A server's token may be visible shortly before requests can reach it."""
    asked = 0

    def answer_late(query: zenoh.Query) -> None:
        nonlocal asked
        asked += 1
        if asked == 3:
            query.reply(ADD_KEY, cdr.encode(AddTwoInts.Response(sum=3)))
        query.drop()

    async with quiet_node("client") as node:
        with raw_session() as session, raw_server(session, answer_late):
            client = node.create_client(AddTwoInts, "add")
            await client.wait_for_service()
            assert (await client.call(AddTwoInts.Request())).sum == 3


async def test_strange_requests_are_answered_with_an_error_and_stop_nothing(
    caplog: pytest.LogCaptureFixture,
) -> None:
    """Any process may call any service with any data."""
    good = cdr.encode(AddTwoInts.Request(a=1, b=2))
    async with quiet_node("server") as node:
        node.create_service(AddTwoInts, "add", add)
        with raw_session() as session:
            await known(session, f"@ros2_lv/{DOMAIN_ID}/**/SS/**", 1)
            with caplog.at_level(logging.WARNING, "aionode.transport.zenoh"):
                for payload in (None, b"", b"\0\1\0\0\1"):
                    reply = await raw_reply(session, ADD_KEY, payload, None)
                    assert reply.err is not None
                    assert b"DecodeError" in reply.err.payload.to_bytes()
                for extra in (None, b"", bytes(200), attachment.pack(1, 1, GID)):
                    reply = await raw_reply(session, ADD_KEY, good, extra)
                    assert reply.ok is not None
                    answer = cdr.decode(AddTwoInts.Response, reply.ok.payload.to_bytes())
                    assert answer == AddTwoInts.Response(sum=3)

    assert sum("unknown form" in text for text in caplog.messages) == 1


def remembering(heard: list[Any], response: Any) -> Callable[[Any], Any]:
    """Return a handler that notes requests."""

    def answer(request: Any) -> Any:
        heard.append(request)
        return response

    return answer


# Errors as text


def test_an_error_keeps_its_type_and_text() -> None:
    """The client gets the error that the server raised."""
    error = parse_error(error_payload("ValueError", "too large: 5 \N{MICRO SIGN}m"), "/s")

    assert (error.service, error.error_type) == ("/s", "ValueError")
    assert error.error_text == "too large: 5 \N{MICRO SIGN}m"


@pytest.mark.parametrize("payload", [b"boom", b"{}", b"[1]", b"3", b"\xff\xfe", b""])
def test_any_other_payload_is_an_error_too(payload: bytes) -> None:
    """Whatever a server sends in place of an answer, the caller gets an error."""
    assert str(parse_error(payload, "/s")).startswith("/s: ")
