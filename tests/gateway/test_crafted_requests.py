"""Handwritten requests: such as no browser or library sends, and such as malicious pages might.

Each is sent over a socket exactly as written here; ``PORT`` is the port of the gateway.
"""

from __future__ import annotations

import asyncio
import base64
import logging
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from typing import NamedTuple

import pytest

from aionode.engine.context import Context
from aionode.gateway import Gateway, Policy
from aionode.interfaces.std_msgs.msg import String
from aionode.node import Node

POLICY = """
hosts = ["robot.example"]
origins = ["https://dash.example"]
[[who]]
name = "local"
loopback = true
[[who]]
name = "operator"
token = "secret"
[[allow]]
see = "/**"
subscribe = "/**"
parameter = "/**"
"""


class Answer(NamedTuple):
    """An answer of the gateway."""

    status: int
    headers: dict[str, str]
    body: bytes


class Sender:
    """Sends bytes to a gateway."""

    def __init__(self, port: int) -> None:
        self.port = port

    async def ask(self, line: str, *headers: str) -> Answer:
        """Return the answer to a request with exactly these headers."""
        text = "\r\n".join([line, *headers, "", ""]).replace("PORT", str(self.port))
        reader, writer = await asyncio.open_connection("127.0.0.1", self.port)
        try:
            writer.write(text.encode("latin-1"))
            head = (await reader.readuntil(b"\r\n\r\n")).decode("latin-1").split("\r\n")
            fields = dict(each.lower().split(": ", 1) for each in head[1:] if each)
            is_empty = line.startswith("HEAD") or head[0].split()[1] == "101"
            body = b"" if is_empty else await reader.read()
            return Answer(int(head[0].split()[1]), fields, body)
        finally:
            writer.close()


@asynccontextmanager
async def sender_of(context: Context) -> AsyncIterator[Sender]:
    """Yield a sender of bytes to a gateway."""
    async with (
        Node("gateway", context=context) as node,
        Gateway(node, Policy.parse(POLICY), port=0) as gateway,
    ):
        node.create_publisher(String, "/words", 1)
        yield Sender(gateway.port)


ENDS = "Connection: close"
HERE = "Host: 127.0.0.1:PORT"

HOSTS = [
    ("127.0.0.1:PORT", 200),
    ("127.0.0.1", 200),
    ("LOCALHOST:PORT", 200),
    ("[::1]:PORT", 200),
    ("[::ffff:127.0.0.1]:PORT", 200),
    ("[fe80::1%eth0]:PORT", 200),
    ("ROBOT.example:PORT", 200),
    ("", 401),
    (":PORT", 401),
    ("::1", 401),
    ("[::1", 401),
    ("127.0.0.1:PORT:PORT", 401),
    ("127.0.0.1:x", 401),
    ("127.0.0.1.", 401),
    ("robot.example.", 401),
    ("rob\xf6t.example", 401),
    ("127.0.0.1.evil.example", 401),
    ("localhost.evil.example", 401),
    ("evil.example@127.0.0.1", 401),
    ("127.0.0.1@evil.example", 401),
    ("127.0.0.1:80@evil.example", 401),
    ("127.0.0.1/evil.example", 401),
    ("127.0.0.1?evil.example", 401),
    ("127.0.0.1#evil.example", 401),
    ("127.0.0.1\\evil.example", 401),
    ("127.0.0.1, evil.example", 401),
    ("2130706433", 401),
    ("0x7f.1", 401),
    ("robot.example evil.example", 401),
]


async def test_a_request_names_this_machine(aionode_context: Context) -> None:
    """By an address, which no page can rebind, or by a name that the policy lists."""
    async with sender_of(aionode_context) as sender:
        answers = {
            host: (await sender.ask("GET /topics HTTP/1.1", f"Host: {host}", ENDS)).status
            for host, _ in HOSTS
        }
    assert answers == dict(HOSTS)


ORIGINS = [
    (["http://127.0.0.1:PORT"], 200),
    (["https://dash.example"], 200),
    (["null"], 401),
    ([""], 401),
    (["http://127.0.0.1"], 401),
    (["http://127.0.0.1:80"], 401),
    (["https://127.0.0.1:PORT"], 401),
    (["http://localhost:PORT"], 401),
    (["http://127.0.0.1:PORT/"], 401),
    (["http://evil@127.0.0.1:PORT"], 401),
    (["http://127.0.0.1:PORT.evil.example"], 401),
    (["HTTP://127.0.0.1:PORT"], 401),
    (["https://DASH.example"], 401),
    (["https://dash.example:443"], 401),
    (["https://dash.example:8443"], 401),
    (["http://dash.example"], 401),
    (["https://dash.example.evil.example"], 401),
    (["https://dash.example http://127.0.0.1:PORT"], 401),
    (["https://evil.example", "https://dash.example"], 401),
    (["https://dash.example", "https://evil.example"], 401),
]


async def test_a_page_is_of_this_gateway_or_of_a_listed_origin(aionode_context: Context) -> None:
    """Exactly as browsers write it; if there are two, neither counts."""
    async with sender_of(aionode_context) as sender:
        for origins, status in ORIGINS:
            headers = [HERE, *(f"Origin: {origin}" for origin in origins), ENDS]
            answer = await sender.ask("GET /topics HTTP/1.1", *headers)
            listed = "https://dash.example" if origins == ["https://dash.example"] else None
            assert (origins, answer.status) == (origins, status)
            assert answer.headers.get("access-control-allow-origin") == listed


REQUESTS: list[tuple[str, list[str], set[int]]] = [
    # no host, or two of them
    ("GET /topics HTTP/1.1", [], {400}),
    ("GET /topics HTTP/1.1", [HERE, "Host: evil.example"], {400}),
    ("GET /topics HTTP/1.0", [], {401}),
    # the browser's information about the page, twice
    ("GET /topics HTTP/1.1", [HERE, "Sec-Fetch-Site: none", "Sec-Fetch-Site: cross-site"], {401}),
    ("GET /topics HTTP/1.1", [HERE, "Sec-Fetch-Site: cross-site", "Sec-Fetch-Site: none"], {401}),
    ("GET /topics HTTP/1.1", [HERE, "SEC-FETCH-SITE: cross-site"], {401}),
    ("GET / HTTP/1.1", [HERE, "Sec-Fetch-Site: cross-site"], {401}),
    # a target with its own host
    ("GET http://evil.example/topics HTTP/1.1", [HERE], {404}),
    ("GET http://127.0.0.1:PORT/topics HTTP/1.1", ["Host: evil.example"], {401}),
    ("GET //evil.example/topics HTTP/1.1", [HERE], {404}),
    # methods, and substitutes for them
    ("TRACE /topics HTTP/1.1", [HERE], {405}),
    ("CONNECT /topics HTTP/1.1", [HERE], {405}),
    ("DELETE /parameters/gateway/rate HTTP/1.1", [HERE], {405}),
    ("GET /topics/words?timeout_sec=0 HTTP/1.1", [HERE, "X-HTTP-Method-Override: POST"], {504}),
    ("POST /parameters/gateway/rate?_method=PUT HTTP/1.1", [HERE, "X-Method-Override: PUT"], {405}),
    ("get /topics HTTP/1.1", [HERE], {405}),
    ("HEAD /topics HTTP/1.1", [HERE], {200}),
    ("HEAD /topics/words HTTP/1.1", [HERE, "Accept: text/event-stream"], {200}),
    # a browser's preflight
    ("OPTIONS /topics HTTP/1.1", [HERE, "Origin: https://evil.example"], {401}),
    ("OPTIONS /topics HTTP/1.1", ["Host: evil.example"], {401}),
    ("OPTIONS * HTTP/1.1", [HERE], {204}),
    # paths that lead elsewhere
    ("GET /page/../topics HTTP/1.1", [HERE], {404}),
    ("GET /page/%2e%2e/topics HTTP/1.1", [HERE], {404}),
    ("GET /page/..%2f..%2f_policy.py HTTP/1.1", [HERE], {404}),
    ("GET /page/..%5c_policy.py HTTP/1.1", [HERE], {404}),
    ("GET /page/%252e%252e%252f_policy.py HTTP/1.1", [HERE], {404}),
    ("GET /page//etc/passwd HTTP/1.1", [HERE], {404}),
    ("GET /page/app.js%00.html HTTP/1.1", [HERE], {404}),
    ("GET /topics/..%2fnodes HTTP/1.1", [HERE], {400, 404}),
    # the name contains no line break
    ("GET /topics/words%0a?timeout_sec=0 HTTP/1.1", [HERE], {504}),
    ("GET /topics/w%D0%BErds HTTP/1.1", [HERE], {400, 404}),
    ("GET /topics/%ef%bd%97ords HTTP/1.1", [HERE], {400, 404}),
    # would-be headers of the answer
    ("GET /page/x%0d%0aSet-Cookie:%20a=b/ HTTP/1.1", [HERE], {307, 404}),
    ("GET /topics/%0d%0aSet-Cookie:%20a=b HTTP/1.1", [HERE], {400, 404}),
    ("GET /topics?type=%0d%0aSet-Cookie:%20a=b HTTP/1.1", [HERE], {200}),
    ("GET /topics HTTP/1.1", [HERE, "Origin: http://evil.example\x1b[31m"], {400, 401}),
    # credentials, twice or in pieces
    ("GET /topics HTTP/1.1", [HERE, "Authorization: Bearer wrong"], {401}),
    ("GET /topics?token=wrong HTTP/1.1", [HERE], {401}),
    ("GET /topics HTTP/1.1", [HERE, "Authorization: Bearer secret,wrong"], {401}),
    ("GET /topics HTTP/1.1", [HERE, "Authorization: bearer  secret "], {200}),
    ("GET /topics HTTP/1.1", [HERE, "X-Forwarded-For: 127.0.0.1"], {401}),
]


async def test_a_request_that_is_crafted_gets_no_further_than_others(
    aionode_context: Context,
) -> None:
    """Its status says so, and nothing of it becomes a header of the answer."""
    async with sender_of(aionode_context) as sender:
        for line, headers, statuses in REQUESTS:
            answer = await sender.ask(line, *headers, ENDS)
            assert answer.status in statuses, (line, headers, answer)
            assert "set-cookie" not in answer.headers
            assert "evil" not in str(answer.headers)


async def test_a_page_of_a_listed_origin_is_told_what_it_may_send(
    aionode_context: Context,
) -> None:
    """Only that page, and a cache keeps the answers apart."""
    async with sender_of(aionode_context) as sender:
        line, wants = "OPTIONS /topics/x HTTP/1.1", "Access-Control-Request-Method: POST"
        told = await sender.ask(line, HERE, "Origin: https://dash.example", wants, ENDS)
        own = await sender.ask(line, HERE, "Origin: http://127.0.0.1:PORT", wants, ENDS)
    assert told.headers["access-control-allow-origin"] == "https://dash.example"
    assert told.headers["vary"] == "origin"
    assert "access-control-allow-credentials" not in told.headers
    assert "access-control-allow-origin" not in own.headers


async def test_a_malformed_request_is_no_line_in_the_log(
    aionode_context: Context, caplog: pytest.LogCaptureFixture
) -> None:
    """A client may send ten thousand a second; text that is not UTF-8 is not logged either."""
    key = base64.b64encode(b"0" * 16).decode()
    upgrade = "GET / HTTP/1.1\r\nConnection: Upgrade\r\nUpgrade: websocket\r\nHost: 127.0.0.1\r\n"
    upgrade += f"Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: {key}\r\n\r\n"
    no_text = b"\x81\x81\x00\x00\x00\x00\xff"  # one masked byte
    other = b"GET /topics HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: Upgrade\r\nUpgrade: x\r\n\r\n"
    async with sender_of(aionode_context) as sender:
        for exchanges in (
            ((b"garbage\r\n\r\n", b"400"),),
            ((other, b"200"),),
            ((upgrade.encode(), b"\r\n\r\n"), (no_text, b"\x03\xef")),  # 1007: invalid payload
        ):
            reader, writer = await asyncio.open_connection("127.0.0.1", sender.port)
            try:
                for data, answered in exchanges:
                    writer.write(data)
                    await asyncio.wait_for(reader.readuntil(answered), 10)
            finally:
                writer.close()
    assert [each for each in caplog.records if each.levelno >= logging.WARNING] == []


PROTOCOLS = [
    ("", 101, None),
    ("rosbridge_v2", 101, "rosbridge_v2"),
    ("bearer.secret, rosbridge_v2", 101, "rosbridge_v2"),
    ("foxglove.sdk.v1, bearer.secret", 101, "foxglove.sdk.v1"),
    ("foxglove.sdk.v1, bearer.wrong", 401, None),
    ("bearer.wrong", 401, None),
    ("bearer.secret", 101, None),
    ("bearer.secret, bearer.wrong", 401, None),
    ("foxglove.websocket.v1", 101, "foxglove.websocket.v1"),
    ("foxglove.websocket.v1, foxglove.sdk.v1", 101, "foxglove.websocket.v1"),
    ("graphql-ws", 400, None),
    ("graphql-ws, foxglove.websocket.v1", 101, "foxglove.websocket.v1"),
    ("bearer.secret, foxglove.sdk.v2", 400, None),
]


async def test_a_subprotocol_is_chosen_and_none_is_a_token(aionode_context: Context) -> None:
    """The answer repeats a protocol that the client offered, but never its token."""
    key = base64.b64encode(b"0" * 16).decode()
    upgrade = ["Connection: Upgrade", "Upgrade: websocket", "Sec-WebSocket-Version: 13"]
    async with sender_of(aionode_context) as sender:
        for offered, status, chosen in PROTOCOLS:
            protocols = [f"Sec-WebSocket-Protocol: {offered}"] if offered else []
            head = [HERE, *upgrade, f"Sec-WebSocket-Key: {key}", *protocols]
            answer = await asyncio.wait_for(sender.ask("GET / HTTP/1.1", *head), 10)
            found = answer.headers.get("sec-websocket-protocol")
            assert (offered, answer.status, found) == (offered, status, chosen)


@pytest.mark.parametrize(
    "text",
    [
        "origins = ['null']",
        "origins = ['*']",
        "origins = ['https://*.example']",
        "origins = ['https://Dash.example']",
        "origins = ['https://dash.example/']",
        "origins = ['https://dash.example:443']",
        "origins = ['http://dash.example:80']",
        "origins = ['dash.example']",
        "origins = ['https://user@dash.example']",
        "hosts = ['robot.example:9090']",
        "hosts = ['http://robot.example']",
        "hosts = ['*']",
        "[[who]]\nname = 'page'\norigin = 'null'",
    ],
)
def test_an_origin_or_a_host_that_fits_no_page_is_a_mistake_in_the_file(text: str) -> None:
    """It would have no effect, or let in any sandboxed page."""
    with pytest.raises(ValueError, match=r"origin|hosts"):
        Policy.parse(text)
