"""The web server alone: an ASGI application over real connections, in and out of order."""

from __future__ import annotations

import asyncio
import socket
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from aionode.gateway import Policy
from aionode.gateway.server.server import Server
from tests.support.gateway_server import UPGRADE

HOST = b"Host: robot\r\n"


async def echo(scope: Any, receive: Any, send: Any) -> None:
    """Answer with the path and the body; some paths do something else."""
    if scope["type"] == "websocket":
        await receive()
        await send({"type": "websocket.accept"})
        message = await receive()
        await send({"type": "websocket.send", "text": f"{scope['path']} {message['text']}"})
        await send({"type": "websocket.close", "code": 1000})
        return
    if scope["path"] == "/fault":
        raise ValueError("on purpose")
    if scope["path"] == "/silent":
        return
    body, more = b"", scope["path"] != "/unread"
    while more:
        message = await receive()
        body += message.get("body", b"")
        more = message.get("more_body", False)
    text = b"%s %s %s" % (scope["method"].encode(), scope["path"].encode(), body)
    headers = [] if scope["path"] == "/chunks" else [(b"content-length", b"%d" % len(text))]
    await send({"type": "http.response.start", "status": 200, "headers": headers})
    for part in (text[:3], text[3:]):
        await send({"type": "http.response.body", "body": part, "more_body": True})
    await send({"type": "http.response.body"})


@asynccontextmanager
async def served(limits: str = "") -> AsyncIterator[int]:
    """Yield the port of a server of `echo`."""
    policy = Policy.parse(f"[limits]\n{limits}")
    listener = socket.create_server(("127.0.0.1", 0))
    server = Server(echo, lambda: policy)
    async with asyncio.TaskGroup() as tasks:
        tasks.create_task(server.serve(listener))
        await server.has_started.wait()
        try:
            yield listener.getsockname()[1]
        finally:
            server.stop()


async def told(sent: bytes, *more: bytes, limits: str = "handshake_sec = 0.2") -> bytes:
    """Return everything that the server answers to some bytes, until it closes the connection."""
    async with served(limits) as port:
        reader, writer = await asyncio.open_connection("127.0.0.1", port)
        for part in (sent, *more):
            writer.write(part)
            await asyncio.sleep(0)  # noqa: TID251  # a part by itself
        answer = await reader.read()
        writer.close()
        return answer


def bodies(answer: bytes) -> list[bytes]:
    """Return what follows each header."""
    return [part.partition(b"\r\n\r\n")[2] for part in answer.split(b"HTTP/1.1 ")[1:]]


async def test_requests_that_arrive_at_once_are_answered_in_their_order() -> None:
    """A program need not wait for one answer before it sends the next request."""
    get = b"GET /%d HTTP/1.1\r\n" + HOST + b"\r\n"

    answer = await told(get % 1 + get % 2 + get % 3)

    assert bodies(answer) == [b"GET /1 ", b"GET /2 ", b"GET /3 "]


async def test_the_head_of_an_answer_is_sent_without_its_body() -> None:
    """For HEAD; the length is that of the body that GET would return."""
    answer = await told(b"HEAD /x HTTP/1.1\r\n" + HOST + b"\r\n")

    assert b"content-length: 8" in answer
    assert bodies(answer) == [b""]


async def test_a_client_that_waits_for_permission_is_told_to_continue() -> None:
    """Curl waits for it before it sends a large body."""
    head = b"POST /x HTTP/1.1\r\n" + HOST + b"Content-Length: 4\r\nExpect: 100-continue\r\n\r\n"
    async with served() as port:
        reader, writer = await asyncio.open_connection("127.0.0.1", port)
        writer.write(head)
        leave = await reader.readuntil(b"\r\n\r\n")
        writer.write(b"body")
        answer = await reader.readuntil(b"POST /x body")
        writer.close()

    assert leave.startswith(b"HTTP/1.1 100 ")
    assert answer.startswith(b"HTTP/1.1 200 OK")


async def test_a_body_that_the_application_has_not_read_is_no_request() -> None:
    """The rest of it is removed from the connection before the next request."""
    body = b"GET /of-the-body HTTP/1.1\r\n\r\n"
    post = b"POST /unread HTTP/1.1\r\n" + HOST + b"Content-Length: %d\r\n\r\n" % len(body)

    answer = await told(post + body[:9], body[9:] + b"GET /next HTTP/1.1\r\n" + HOST + b"\r\n")

    assert bodies(answer) == [b"POST /unread ", b"GET /next "]


async def test_an_answer_of_unknown_length_comes_in_chunks() -> None:
    """The connection stays open; one of HTTP/1.0 is closed instead."""
    new = await told(b"GET /chunks HTTP/1.1\r\n" + HOST + b"\r\n")
    old = await told(b"GET /chunks HTTP/1.0\r\n\r\n")

    assert b"transfer-encoding: chunked" in new.lower()
    assert bodies(old) == [b"GET /chunks "]


@pytest.mark.parametrize(
    ("sent", "status"),
    [
        (b"nonsense\r\n\r\n", b"400 Bad Request"),
        (b"GET / HTTP/1.1\r\n\r\n", b"400 Bad Request"),
        (b"GET / HTTP/1.1\r\n" + HOST + b"X: " + b"x" * 20_000, b"431 "),
        (b"GET /fault HTTP/1.1\r\n" + HOST + b"\r\n", b"500 Internal Server Error"),
        (b"GET /silent HTTP/1.1\r\n" + HOST + b"\r\n", b""),
        (b"POST /x HTTP/1.1\r\n" + HOST + b"Transfer-Encoding: chunked\r\n\r\nz\r\n", b"400 "),
        (UPGRADE.format(path="/", more="").replace("13", "12").encode(), b"400 Bad Request"),
        (UPGRADE.format(path="/", more="").replace("GET", "POST").encode(), b"200 OK"),
        (UPGRADE.format(path="/", more="").replace("1.1", "1.0").encode(), b"200 OK"),
        (UPGRADE.format(path="/", more="Content-Length: 1\r\n").encode() + b"x", b"200 OK"),
    ],
)
async def test_what_cannot_be_answered_ends_the_connection(sent: bytes, status: bytes) -> None:
    """With a status if none was sent: nobody could tell where the next request begins."""
    answer = await told(sent)

    assert answer.startswith(b"HTTP/1.1 " + status if status else b"")
    assert answer.count(b"HTTP/1.1") <= 1


async def test_frames_may_follow_the_request_of_a_websocket_at_once() -> None:
    """Whatever part of them has arrived with it."""
    frame = bytes([0x81, 0x82, 0, 0, 0, 0]) + b"hi"
    goodbye = bytes([0x88, 0x80, 0, 0, 0, 0])
    async with served() as port:
        for cut in range(len(frame) + 1):
            reader, writer = await asyncio.open_connection("127.0.0.1", port)
            writer.write(UPGRADE.format(path="/ws", more="").encode() + frame[:cut])
            writer.write(frame[cut:])
            head = await reader.readuntil(b"\r\n\r\n")
            said = await reader.readexactly(12)
            writer.write(goodbye)

            assert head.startswith(b"HTTP/1.1 101 Switching Protocols")
            assert said == bytes([0x81, 6]) + b"/ws hi" + bytes([0x88, 2, 3, 232])
            assert await reader.read() == b""
            writer.close()


@given(st.lists(st.integers(1, 30), max_size=12))
def test_it_does_not_matter_how_requests_are_cut(sizes: list[int]) -> None:
    """A network may split them anywhere."""
    post = b"POST /a HTTP/1.1\r\n" + HOST + b"Content-Length: 3\r\n\r\nabc"
    stream = post + b"GET /b HTTP/1.1\r\n" + HOST + b"Connection: close\r\n\r\n"
    parts = []
    for size in sizes:
        parts.append(stream[:size])
        stream = stream[size:]

    answer = asyncio.run(told(*parts, stream, limits=""))  # however long the parts take

    assert bodies(answer) == [b"POST /a abc", b"GET /b "]
