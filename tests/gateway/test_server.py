"""The door of the gateway, over sockets of this host: who gets in, and what a connection may do."""

from __future__ import annotations

import asyncio
import contextlib
import json
import logging
import signal
import socket
from collections.abc import AsyncIterator
from pathlib import Path
from typing import Any

import pytest
from websockets.asyncio.client import connect
from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.typing import Origin

from aionode.engine.context import Context
from aionode.errors import ConfigurationError, RefusedError
from aionode.gateway import Gateway, Identity, Policy
from aionode.gateway._gateway import paced
from aionode.gateway.server.door import Guesses
from aionode.interfaces.geometry_msgs.msg import Twist
from aionode.interfaces.std_msgs.msg import String
from aionode.node import Node
from aionode.testing import local_context, settle
from tests.support.gateway_bench import Bench
from tests.support.gateway_server import (
    address,
    drive,
    get,
    http_client,
    raw_connect,
    serving,
    session_of,
    sessions_of,
    subscribers_of,
)
from tests.support.waiting import until

TOKEN = "a-token-that-nobody-may-read"
POLICY = f"""
[[who]]
name = "operator"
token = "{TOKEN}"
[[who]]
name = "local"
loopback = true
[[allow]]
see = "/**"
publish = "/**"
"""
DRIVE = drive(1.0)


async def test_small_frames_wait_for_no_acknowledgement() -> None:
    """A client acknowledges after 40 ms, which each answer in two parts would take."""
    async with serving() as gateway, connect(address(gateway), proxy=None):
        session = session_of(gateway)
        connection: Any = session.arrivals.connection
        connected = connection.transport.get_extra_info("socket")

        assert connected.getsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY)


STRANGERS = (
    {"origin": "http://evil.example"},
    {"origin": "null"},
    {"host": "evil.example"},
    {"host": "evil.example", "origin": "http://evil.example"},
    {"sec-fetch-site": "cross-site"},
    {"authorization": "Bearer wrong"},
)


async def test_strangers_are_refused_on_every_way_in() -> None:
    """Pages of other origins, rebound names, wrong tokens."""
    async with serving(Policy.parse(POLICY)) as gateway:
        for headers in STRANGERS:
            public = [] if "authorization" in headers else ["/"]  # the page itself
            for path in (*public, "/topics", "/openapi.json", "/metrics", "/nothing"):
                answer = await get(gateway, path, headers)
                assert (answer.status_code, answer.json()["code"]) == (401, "unauthorized")
                assert answer.headers["cross-origin-resource-policy"] == "same-origin"
            for path, protocols in (("/", []), ("/ws", []), ("/", ["foxglove.sdk.v1"])):
                with pytest.raises(InvalidStatus) as refused:
                    async with raw_connect(gateway, path, headers, protocols):
                        pass
                assert refused.value.response.status_code == 401
        assert gateway.stats.sessions == {}


async def test_refused_clients_are_one_warning_in_the_log(caplog: pytest.LogCaptureFixture) -> None:
    """It names the origin, which a browser hides from its page; and nobody can fill the log."""
    caplog.set_level(logging.WARNING)
    async with serving() as gateway:
        for _ in range(3):
            with pytest.raises(InvalidStatus, match="401"):
                await connect(address(gateway), origin=Origin("http://evil.example"))

    (warning,) = [each for each in caplog.records if each.levelno >= logging.WARNING]
    assert warning.levelno == logging.WARNING
    assert "http://evil.example" in warning.message
    assert "`origins`" in warning.message


async def test_a_page_of_an_allowed_origin_may_read_the_answers() -> None:
    """A browser first asks what such a page may do."""
    origin = "https://dash.example"
    policy = Policy.parse(f"origins = ['{origin}']\n{POLICY}")
    async with serving(policy) as gateway, http_client() as client:
        url = f"http://127.0.0.1:{gateway.port}/topics"
        asked = await client.options(url, headers={"origin": origin})
        answer = await get(gateway, headers={"origin": origin})
        refused = await client.options(url, headers={"origin": "https://evil.example"})
    assert asked.status_code == 204
    assert asked.headers["access-control-allow-origin"] == origin
    assert answer.headers["access-control-allow-origin"] == origin
    assert refused.status_code == 401
    assert "access-control-allow-origin" not in refused.headers


async def test_a_token_is_taken_from_each_place_and_is_in_no_log(
    caplog: pytest.LogCaptureFixture, tmp_path: Path
) -> None:
    """Header, subprotocol and address; servers write the last one into logs."""
    caplog.set_level(logging.DEBUG)
    caplog.set_level(logging.INFO, "websockets.client")  # the test's own side
    caplog.set_level(logging.INFO, "httpx")
    caplog.set_level(logging.INFO, "httpcore")
    logging.getLogger("httpx").disabled = True
    log = tmp_path / "audit"
    got: list[Twist] = []
    async with serving(Policy.parse(f"audit_file = '{log}'\n{POLICY}")) as gateway:
        gateway.node.create_subscription(Twist, "/cmd_vel", got.append)
        await get(gateway, headers={"authorization": f"Bearer {TOKEN}"})
        await get(gateway, f"/topics?token={TOKEN}")
        await get(gateway, f"/topics?token={TOKEN}x")
        for path, protocols in ((f"/?token={TOKEN}", []), ("/", ["rosbridge", f"bearer.{TOKEN}"])):
            async with raw_connect(gateway, path, {}, protocols) as websocket:
                await websocket.send(DRIVE)
                await until(lambda: got)
            await until(lambda: not gateway.stats.sessions)
            got.clear()
    logging.getLogger("httpx").disabled = False
    lines = [json.loads(line) for line in log.read_text().splitlines()]
    assert {line["who"] for line in lines if line["action"] == "publish"} == {"operator"}
    assert "its token is unknown" in caplog.text  # everything written is captured
    assert TOKEN not in caplog.text + log.read_text()
    assert log.stat().st_mode & 0o777 == 0o600


async def test_an_error_of_the_program_propagates_unchanged() -> None:
    """It is not in a group, so `except` finds it."""
    with pytest.raises(LookupError, match="of the program"):
        async with serving():
            raise LookupError("of the program")


async def test_another_interface_needs_a_secret() -> None:
    """A gateway that anybody on the network could use does not start."""
    async with local_context() as context, Node("gateway", context=context) as node:
        for host in ("0.0.0.0", "", "::", "192.168.0.7"):  # noqa: S104  # that is what is refused
            with pytest.raises(ConfigurationError, match="token or certificate"):
                Gateway(node, Policy.default(allow_write=True), host=host)
            Gateway(node, Policy.parse(POLICY), host=host)


async def test_an_address_that_a_client_claims_is_not_believed() -> None:
    """Any program can send such a header, to pass for a local one, or for another client."""
    claimed = {"x-forwarded-for": "203.0.113.9"}
    async with (
        serving(Policy.parse(POLICY)) as gateway,
        raw_connect(gateway, f"/?token={TOKEN}", claimed, []),
    ):
        await until(lambda: gateway.stats.sessions)
        session = session_of(gateway)
        assert session.identity.address == "127.0.0.1"


FORWARDED = (
    {"forwarded": "for=203.0.113.9"},
    {"X-Forwarded-For": "127.0.0.1"},
    {"x-forwarded-proto": "https"},
    {"X-Real-IP": "203.0.113.9"},
    {"via": "1.1 proxy"},
)


@pytest.mark.parametrize("headers", FORWARDED, ids=lambda headers: next(iter(headers)))
async def test_a_client_behind_a_proxy_is_not_of_this_machine(headers: dict[str, str]) -> None:
    """The proxy is, and speaks for everybody that reaches it: only a token distinguishes them."""
    async with serving(Policy.parse(POLICY)) as gateway:
        assert (await get(gateway)).status_code == 200
        assert (await get(gateway, headers=headers)).status_code == 401
        known = {**headers, "authorization": f"Bearer {TOKEN}"}
        assert (await get(gateway, headers=known)).status_code == 200
        for protocols in ([], ["foxglove.sdk.v1"]):
            with pytest.raises(InvalidStatus, match="401"):
                async with raw_connect(gateway, "/", headers, protocols):
                    pass
            async with raw_connect(gateway, "/", known, protocols):
                pass


TRIES: tuple[tuple[str, dict[str, str], list[str] | None], ...] = (
    ("/topics", {"authorization": "Bearer wrong"}, None),
    ("/topics?token=wrong", {}, None),
    ("/nothing?token=wrong", {}, None),
    ("/", {"authorization": "Bearer wrong"}, []),
    ("/ws?token=wrong", {}, []),
    ("/", {}, ["bearer.wrong"]),
    ("/", {}, ["foxglove.sdk.v1", "bearer.wrong"]),
)


async def status_of(
    gateway: Gateway, path: str, headers: dict[str, str], protocols: list[str] | None
) -> int:
    """Return the status of the answer to a request, or to the start of a WebSocket."""
    if protocols is None:
        return (await get(gateway, path, headers)).status_code
    try:
        async with raw_connect(gateway, path, headers, protocols):
            return 101
    except InvalidStatus as refused:
        return refused.response.status_code


@pytest.mark.parametrize("first", range(len(TRIES)))
async def test_attempts_with_tokens_are_limited(
    first: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Whatever the protocol: not even the right one counts then, or its answer would reveal it."""
    monkeypatch.setattr(
        "aionode.gateway.server.door.WRONG_NS", 10**15
    )  # the test may take some seconds
    right = {"authorization": f"Bearer {TOKEN}"}
    async with (
        serving(Policy.parse(POLICY)) as gateway,
        raw_connect(gateway, "/", right, []) as connected,
    ):
        for _ in range(10):
            assert await status_of(gateway, *TRIES[first]) == 401
        for each in TRIES:
            assert await status_of(gateway, *each) == 429
        assert await status_of(gateway, "/topics", right, None) == 429
        # a client that needs no token is not guessing
        assert (await get(gateway)).status_code == 200
        await connected.send(json.dumps({"op": "call_service", "service": "/rosapi/get_time"}))
        assert json.loads(await connected.recv())["op"] == "service_response"


def test_one_more_token_is_judged_each_second() -> None:
    """From each place; and the number of remembered places is bounded."""
    now_ns = 0
    guesses = Guesses(lambda: now_ns)

    def judged(address: str, tries: int = 100) -> int:
        found = 0
        for _ in range(tries):
            with contextlib.suppress(RefusedError):
                guesses.check(address)
                guesses.note_wrong(address)
                found += 1
        return found

    assert judged("192.0.2.1") == 10
    assert judged("192.0.2.2") == 10
    assert judged("2001:db8::1", 6) + judged("2001:db8::2") == 10  # one host has both
    assert judged("2001:db8:0:1::1") == 10
    now_ns += 3 * 10**9
    assert judged("192.0.2.1") == 3
    now_ns += 3600 * 10**9
    assert judged("192.0.2.1") == 10
    assert judged("192.0.2.1") == 0
    for number in range(10_000):
        guesses.note_wrong(f"10.0.{number >> 8}.{number & 255}")
    assert judged("192.0.2.1") == 10  # 10,000 places are kept, and the oldest is forgotten


async def test_what_is_too_large_is_refused() -> None:
    """The body of a request, and a frame: a client must not exhaust the robot's memory."""
    policy = Policy.parse(f"{POLICY}\n[limits]\nframe_bytes = 1000")
    async with serving(policy) as gateway, http_client() as client:
        url = f"http://127.0.0.1:{gateway.port}/publish/x"
        async with raw_connect(gateway, "/", {}, []) as websocket:
            await websocket.send("x" * 2000)
            with pytest.raises(ConnectionClosed):
                await websocket.recv()
        answer = await client.post(url, content=b"x" * 2000)
        assert answer.status_code in {404, 405, 413}
        await until(lambda: not gateway.stats.sessions)


async def test_the_number_of_clients_is_limited() -> None:
    """The next one is refused, and may connect when one has left."""
    async with serving(Policy.parse(f"{POLICY}\n[limits]\nclients = 2")) as gateway:
        async with raw_connect(gateway, "/", {}, []), raw_connect(gateway, "/", {}, []):
            await until(lambda: sum(gateway.stats.sessions.values()) == 2)
            with pytest.raises(InvalidStatus) as refused:
                async with raw_connect(gateway, "/", {}, []):
                    pass
            assert refused.value.response.status_code == 429
        await until(lambda: not gateway.stats.sessions)
        assert (await get(gateway)).status_code == 200


async def test_a_client_that_says_nothing_is_disconnected() -> None:
    """Otherwise some hundred such connections keep all others out."""
    async with serving(Policy.parse(f"{POLICY}\n[limits]\nhandshake_sec = 0.05")) as gateway:
        for beginning in (b"", b"GET / HTTP/1.1\r\nHost: 127.0.0.1\r\nX-Slow: "):
            reader, writer = await asyncio.open_connection("127.0.0.1", gateway.port)
            writer.write(beginning)
            with contextlib.suppress(ConnectionResetError):  # closed in either way
                assert await asyncio.wait_for(reader.read(), 20) == b""
            writer.close()


async def test_the_stop_is_sent_when_a_connection_breaks() -> None:
    """Without notice from the client, as when its process is killed."""
    got: list[float] = []
    async with serving(Policy.default(allow_write=True)) as gateway:
        gateway.node.create_subscription(Twist, "/cmd_vel", lambda msg: got.append(msg.linear.x))
        async with raw_connect(gateway, "/", {}, []) as websocket:
            await websocket.send(DRIVE)
            await until(lambda: got == [1.0])
            assert gateway.stats.holders == {"/cmd_vel": "local"}
            websocket.transport.abort()
            await until(lambda: got == [1.0, 0.0])
        await until(lambda: not gateway.stats.sessions)


async def test_the_stop_is_sent_when_the_gateway_ends() -> None:
    """Its port is then free; nobody waits for clients that do not read."""
    got: list[float] = []
    async with local_context() as context, Node("robot", context=context) as robot:
        robot.create_subscription(Twist, "/cmd_vel", lambda msg: got.append(msg.linear.x))
        async with Node("gateway", context=context) as node:
            gateway = Gateway(node, Policy.default(allow_write=True), port=0)
            async with gateway:
                websocket = await connect(address(gateway), proxy=None)
                await websocket.send(DRIVE)
                await until(lambda: got == [1.0])
            assert got == [1.0, 0.0]
            await websocket.close()
            with socket.socket() as probe:
                probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
                probe.bind(("127.0.0.1", gateway.port))


async def test_the_gateway_ends_as_soon_as_its_clients_are_gone(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A server that checks every 100 ms whether it may end adds 200 ms to the end of a program."""
    sleeps: list[float] = []
    sleep = asyncio.sleep  # noqa: TID251  # is what the test notes

    async def noted_sleep(delay: float, *result: Any) -> None:
        sleeps.append(delay)
        await sleep(delay, *result)

    async with http_client() as client, contextlib.AsyncExitStack() as stack:
        async with serving() as gateway:
            await client.get(f"http://127.0.0.1:{gateway.port}/topics")  # stays connected
            await stack.enter_async_context(connect(address(gateway)))
            monkeypatch.setattr(asyncio, "sleep", noted_sleep)
        monkeypatch.undo()
    assert [delay for delay in sleeps if 0 < delay < 1] == []  # longer: pings of a WebSocket


async def test_a_port_that_is_taken_is_an_error() -> None:
    """The process continues: the server must not end it."""
    async with serving() as gateway:
        second = Gateway(gateway.node, port=gateway.port)
        with pytest.raises(OSError, match="in use"):
            await second.__aenter__()


async def test_the_process_is_left_unchanged() -> None:
    """Signal handlers and loggers belong to the program, which may run its own server."""

    def state() -> object:
        handlers = [signal.getsignal(each) for each in (signal.SIGINT, signal.SIGTERM)]
        logs = [
            (log.level, list(log.handlers), log.propagate)
            for log in (logging.getLogger("websockets.server"), logging.getLogger())
        ]
        return handlers, logs

    before = state()
    async with serving() as gateway:
        await get(gateway)
        assert state() == before
    assert state() == before


@pytest.fixture
def quickly(monkeypatch: pytest.MonkeyPatch) -> None:
    """Make the gateway check its policy file every hundredth of a second."""
    monkeypatch.setattr("aionode.gateway._clients.RELOAD_SEC", 0.01)


@pytest.mark.usefixtures("quickly")
async def test_a_policy_file_is_read_again(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    """Clients stay; a file with a mistake changes nothing."""
    path = tmp_path / "policy.toml"
    path.write_text(POLICY)
    async with serving(Policy.load(path)) as gateway, raw_connect(gateway, "/", {}, []):
        await until(lambda: gateway.stats.sessions)
        path.write_text("[[allow]]\nsee = 5")
        await until(lambda: "keeps its current policy" in caplog.text)
        assert gateway.clients.policy.allow
        path.write_text("[[who]]\nname = 'local'\nloopback = true")
        await until(lambda: not gateway.clients.policy.allow)
        session = session_of(gateway)
        with pytest.raises(RefusedError):
            session.rights.decide("publish", "/x", "")
        assert not session.ended.is_set()
        path.write_text("[[who]]\nname = 'operator'\ntoken = 'x'")
        await until(lambda: not gateway.stats.sessions)


@pytest.mark.usefixtures("quickly")
async def test_what_a_changed_policy_file_cannot_change_is_said(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    """The audit log continues in another file, new WebSockets have the new limit; TLS waits."""
    path = tmp_path / "policy.toml"
    logs = [tmp_path / "one", tmp_path / "two"]
    path.write_text(f"audit_file = '{logs[0]}'\n{POLICY}\n[limits]\nframe_bytes = 5000")
    async with serving(Policy.load(path)) as gateway:
        await get(gateway, headers={"origin": "null"})
        await until(logs[0].exists)
        path.write_text(
            f"audit_file = '{logs[1]}'\n{POLICY}\n[limits]\nframe_bytes = 1000\n"
            "[tls]\ncertificate = 'c'\nkey = 'k'"
        )
        with caplog.at_level(logging.INFO):
            await until(lambda: "policy was read again" in caplog.text)
        await get(gateway, headers={"origin": "null"})
        await until(lambda: logs[1].exists() and logs[1].read_text())
        async with raw_connect(gateway, "/", {}, []) as websocket:
            await websocket.send("x" * 2000)
            with pytest.raises(ConnectionClosed):
                await websocket.recv()
        await until(lambda: not gateway.stats.sessions)
    assert len(logs[0].read_text().splitlines()) == 1
    assert "[tls] has changed in the policy; restart the gateway" in caplog.text
    assert f"audit log goes to {logs[1]}" in caplog.text


async def test_a_program_has_sessions_of_its_own() -> None:
    """They may have another protocol, such as one for language models."""
    async with serving() as gateway:
        async with gateway.clients.session(Identity("program"), "own") as session:
            assert "/rosout" in session.graph.topics()
            assert gateway.stats.sessions == {"own": 1}
        assert gateway.stats.sessions == {}


async def test_a_gateway_needs_a_node_that_runs(context: Context) -> None:
    """Otherwise nothing would ever be delivered."""
    with pytest.raises(RuntimeError, match="is not running"):
        await Gateway(Node("late", context=context)).__aenter__()


@pytest.fixture
async def context() -> AsyncIterator[Context]:
    """A separate context."""
    async with local_context() as made:
        yield made


async def test_a_client_that_reads_nothing_slows_nobody_down() -> None:
    """The others get every message; the messages it lacks are counted, and not kept."""
    async with serving() as gateway:
        words = gateway.node.create_publisher(String, "/words", 10)
        subscribing = json.dumps({"op": "subscribe", "topic": "/words", "queue_length": 5})
        async with (
            raw_connect(gateway, "/", {}, []) as idle,
            raw_connect(gateway, "/", {}, []) as reader,
        ):
            for websocket in (idle, reader):
                await websocket.send(subscribing)
            await until(lambda: subscribers_of(gateway) == 2)
            idle.transport.pause_reading()
            for number in range(300):
                words.publish(String(data=f"{number}:" + "x" * 100_000))
                got = json.loads(await reader.recv())
                assert got["msg"]["data"].startswith(f"{number}:")
            assert gateway.stats.dropped["/words"] > 100
            waiting = [session.outbox.waiting_bytes for session in sessions_of(gateway)]
            assert max(waiting) <= 5 * 101_000
            idle.transport.abort()


async def test_a_client_whose_frames_are_refused_is_read_slowly(bench: Bench) -> None:
    """Futile requests must cost the robot almost nothing: the client has to wait."""
    read = 0
    async with bench.session() as session, asyncio.TaskGroup() as tasks:

        async def receive() -> dict[str, str]:
            nonlocal read
            read += 1
            return {"type": "websocket.receive", "text": "garbage"}

        async def serve() -> None:
            receive_paced = paced(receive, 1e6, bench.robot, session)
            while True:
                await receive_paced()
                session.rights.refused += 1

        serving = tasks.create_task(serve())
        await settle()
        assert read == 51
        await bench.advance(1.0)
        assert read == 101
        serving.cancel()


async def test_a_policy_that_lets_nobody_in_is_logged(
    caplog: pytest.LogCaptureFixture,
) -> None:
    """A file with only rules replaces the rules that apply without a file."""
    async with serving(Policy.parse("[[allow]]\nsubscribe = '/**'")):
        assert "[[who]]" in caplog.text


async def test_the_gateway_ends_while_a_client_that_reads_nothing_closes() -> None:
    """Waiting data delays only the end of its own connection."""
    async with asyncio.TaskGroup() as tasks:
        async with serving() as gateway:
            publisher = gateway.node.create_publisher(String, "/words", 1)
            client = await connect(address(gateway), proxy=None, max_size=None)
            await client.send(json.dumps({"op": "subscribe", "topic": "/words"}))
            await until(lambda: gateway.node.count_subscribers("/words"))
            client.transport.pause_reading()
            session = session_of(gateway)
            connection: Any = session.arrivals.connection
            for _ in range(20):
                publisher.publish(String(data="x" * 500_000))
                await settle()
            tasks.create_task(client.close())
            await until(lambda: not gateway.stats.sessions)
            assert not connection.is_lost
        client.transport.abort()
