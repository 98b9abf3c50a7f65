"""Connections that break silently, stall, or never state their purpose."""

from __future__ import annotations

import asyncio
import contextlib
import json
import re
import socket
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from typing import Any

import pytest
from websockets.asyncio.client import ClientConnection, connect
from websockets.exceptions import ConnectionClosed

from aionode.action import CancelResponse
from aionode.gateway import Gateway, Policy
from aionode.gateway.server.websocket import WebSocketConnection
from aionode.interfaces.example_interfaces.action import Fibonacci
from aionode.interfaces.geometry_msgs.msg import Twist
from aionode.interfaces.std_msgs.msg import String
from tests.gateway.load.vanishing import waited_sec
from tests.support.gateway_server import (
    Cable,
    busiest_turn,
    cable,
    connections_of,
    drive,
    get,
    raw_connect,
    serving,
    session_of,
    sessions_of,
    subscribers_of,
    upgraded,
)
from tests.support.waiting import until

TTL_SEC = 0.15

POLICY = f"""
[[who]]
name = "local"
loopback = true
[[allow]]
publish = "/cmd_vel"
lease = {{ ttl_sec = {TTL_SEC}, max_age_sec = 60.0 }}
[[allow]]
see = "/**"
subscribe = "/**"
publish = "/**"
goal = "/**"
[limits]
"""

CLOSED = (ConnectionResetError, BrokenPipeError, asyncio.IncompleteReadError)


def listen(gateway: Gateway) -> list[float]:
    """Return the speeds that the wheels receive."""
    got: list[float] = []
    gateway.node.create_subscription(Twist, "/cmd_vel", lambda msg: got.append(msg.linear.x), 100)
    return got


@asynccontextmanager
async def through(line: Cable) -> AsyncIterator[ClientConnection]:
    """Connect a client through a cable."""
    async with connect(f"ws://127.0.0.1:{line.port}/", proxy=None, close_timeout=1) as client:
        yield client


# A client whose packets vanish


async def test_the_stop_is_sent_when_packets_vanish_and_nobody_else_notices() -> None:
    """An unplugged cable closes no connection: the lease ends, and other clients are unaffected."""
    async with (
        serving(Policy.parse(POLICY)) as gateway,
        cable(gateway) as line,
        raw_connect(gateway, "/", {}, []) as other,
    ):
        got = listen(gateway)
        words = gateway.node.create_publisher(String, "/words", 10)
        subscribing = json.dumps({"op": "subscribe", "topic": "/words", "queue_length": 5})
        async with through(line) as client:
            for each in (client, other):
                await each.send(subscribing)
            await until(lambda: subscribers_of(gateway) == 2)
            await client.send(drive(1.0))
            await until(lambda: got == [1.0])
            line.cut()
            for number in range(100):
                words.publish(String(data=f"{number}:" + "x" * 100_000))
                assert json.loads(await other.recv())["msg"]["data"].startswith(f"{number}:")
            await until(lambda: got == [1.0, 0.0])
            assert max(s.outbox.waiting_bytes for s in sessions_of(gateway)) <= 5 * 101_000
            line.join()


@pytest.mark.parametrize("is_one_way", [False, True], ids=["both ways", "to the gateway only"])
async def test_commands_of_a_cut_count_only_behind_the_answer_to_a_ping(is_one_way: bool) -> None:
    """Commands sent before or during the cut arrive when it ends; they must not move anything."""
    limits = "client_lost_sec = 30.0"
    async with serving(Policy.parse(POLICY + limits)) as gateway, cable(gateway) as line:
        got = listen(gateway)
        async with through(line) as client:
            await client.send(drive(1.0))
            await until(lambda: got == [1.0])
            sent = line.sent_bytes
            line.to_gateway.clear()
            if not is_one_way:
                line.to_client.clear()
            for _ in range(20):
                await client.send(drive(100.0))
            await until(lambda: got == [1.0, 0.0])
            if is_one_way:  # the pong follows the commands
                commands = 20 * len(frame(drive(100.0).encode()))
                await until(lambda: line.sent_bytes > sent + commands)
            session = session_of(gateway)
            line.join()
            await until(lambda: not session.arrivals.is_doubtful)
            while got == [1.0, 0.0]:
                await client.send(drive(2.0))
                await asyncio.sleep(0.01)  # noqa: TID251  # as often as a page sends them

            assert set(got) == {1.0, 0.0, 2.0}


async def test_a_commander_that_gives_no_sign_is_disconnected_and_may_come_back() -> None:
    """After `client_lost_sec`: data held back is discarded, and a new connection is accepted."""
    limits = "client_lost_sec = 0.3"
    async with serving(Policy.parse(POLICY + limits)) as gateway, cable(gateway) as line:
        got = listen(gateway)
        async with through(line) as client:
            await client.send(drive(1.0))
            await until(lambda: got == [1.0])
            line.cut()
            for _ in range(20):
                await client.send(drive(100.0))
            await until(lambda: not gateway.stats.sessions)
            line.join()
            with pytest.raises(ConnectionClosed):
                await client.recv()
        assert got == [1.0, 0.0]
        async with through(line) as client:
            await client.send(drive(2.0))
            await until(lambda: got[2:3] == [2.0])


async def test_a_goal_of_a_client_that_gives_no_sign_is_cancelled() -> None:
    """After `client_lost_sec`; a client that is merely idle answers pings, and keeps its goal."""
    limits = "client_lost_sec = 0.3"
    ends: list[str] = []
    async with serving(Policy.parse(POLICY + limits)) as gateway, cable(gateway) as line:

        async def execute(goal: Any) -> Any:
            try:
                await asyncio.Event().wait()
            finally:
                ends.append(str(goal.request.order))

        gateway.node.create_action_server(
            Fibonacci, "count", execute, cancel_callback=lambda _: CancelResponse.ACCEPT
        )
        async with through(line) as lost, raw_connect(gateway, "/", {}, []) as silent:
            for order, client in enumerate((lost, silent)):
                op = {"op": "send_action_goal", "action": "/count", "args": {"order": order}}
                op |= {"action_type": "example_interfaces/action/Fibonacci", "id": str(order)}
                await client.send(json.dumps(op))
            await until(lambda: all(s.has_goals for s in sessions_of(gateway)))
            line.cut()
            await until(lambda: len(sessions_of(gateway)) == 1 and ends)
            assert ends == ["0"]
            session = session_of(gateway)
            assert session.has_goals
            line.join()


@pytest.mark.stress
@pytest.mark.timeout(300)
async def test_the_stop_comes_within_the_time_to_live_when_a_cable_is_pulled() -> None:
    """Within 0.1 s, nine times out of ten on a busy machine; and nothing moves after it."""
    limits = "client_lost_sec = 30.0\nclients = 8"
    late: list[float] = []
    async with serving(Policy.parse(POLICY + limits)) as gateway, cable(gateway) as line:
        got = listen(gateway)
        loop = asyncio.get_running_loop()
        for _ in range(50):
            got.clear()
            async with through(line) as client:
                while len(got) < 3:
                    await client.send(drive(1.0))
                    await asyncio.sleep(0.02)  # noqa: TID251  # as often as a page sends them
                line.cut()
                began, waited = loop.time(), waited_sec()
                while got[-1] != 0.0:
                    await client.send(drive(1.0))
                    await asyncio.sleep(0.005)  # noqa: TID251  # it goes on
                late.append(loop.time() - began - (waited_sec() - waited))
                stopped = len(got)
                session = session_of(gateway)
                line.join()
                await until(lambda: not session.arrivals.is_doubtful)  # noqa: B023  # awaited at once
                assert len(got) == stopped
            await until(lambda: not gateway.stats.sessions)

    assert sorted(late)[44] <= TTL_SEC + 0.1


# Pings


async def test_a_ping_cannot_be_answered_before_it_is_sent() -> None:
    """Its payload is random: the pong ends a doubt about when commands were sent."""
    async with serving(Policy.parse(POLICY + "client_lost_sec = 6")) as gateway:
        got = listen(gateway)
        reader, writer, _ = await upgraded(gateway)
        writer.write(frame(drive(1.0).encode()))
        for number in range(10):
            writer.write(frame(b"aionode%d" % number, PONG))
        await until(lambda: got == [1.0, 0.0])
        for number in range(10):
            writer.write(frame(b"aionode%d" % number, PONG))
        writer.write(frame(drive(2.0).encode()))
        session = session_of(gateway)
        await until(lambda: session.rights.refused)
        assert got == [1.0, 0.0]
        asked = []
        for _ in range(2):
            asked.append(await ping_of(reader))
            writer.write(frame(b"aionode", PONG))  # else a busy machine makes it a lost client
        assert len({*asked}) == 2
        assert min(map(len, asked)) >= 8
        writer.write(frame(asked[0], PONG))  # RFC 6455 lets a client answer any of them
        await until(lambda: not session.arrivals.is_doubtful)
        writer.close()


async def test_a_sign_that_is_asked_for_meanwhile_leaves_the_doubt() -> None:
    """A client with goals is pinged repeatedly: its pong ends the doubt as well."""
    limits = "client_lost_sec = 0.3"
    async with serving(Policy.parse(POLICY + limits)) as gateway:
        got = listen(gateway)
        reader, writer, _ = await upgraded(gateway)
        writer.write(frame(drive(1.0).encode()))
        await until(lambda: got == [1.0, 0.0])
        session = session_of(gateway)
        for _ in range(3):
            payload = await ping_of(reader)
            assert session.arrivals.is_doubtful
            writer.write(frame(b"", PONG))  # a sign of life, but no answer
        writer.write(frame(payload, PONG))
        await until(lambda: not session.arrivals.is_doubtful)
        writer.close()


TEXT, BINARY, CLOSE, PING, PONG = 1, 2, 8, 9, 10


def frame(payload: bytes, opcode: int = TEXT, *, first: int = 0x80) -> bytes:
    """Return a frame of a client, masked with zeros."""
    size = len(payload)
    if size < 126:
        length = bytes([0x80 | size])
    elif size < 1 << 16:
        length = bytes([0x80 | 126]) + size.to_bytes(2, "big")
    else:
        length = bytes([0x80 | 127]) + size.to_bytes(8, "big")
    return bytes([first | opcode]) + length + bytes(4) + payload


async def ping_of(reader: asyncio.StreamReader) -> bytes:
    """Return the payload of the next ping, ignoring all other frames."""
    while True:
        first, size = await reader.readexactly(2)
        if size == 126:
            size = int.from_bytes(await reader.readexactly(2), "big")
        payload = await reader.readexactly(size)
        if first & 0x0F == PING:
            return payload


# Connections that send nothing, or read nothing


async def closed(reader: asyncio.StreamReader) -> bytes:
    """Wait until the gateway closes a connection, and return the data that it sent."""
    said = b""
    with contextlib.suppress(*CLOSED):
        while data := await reader.read(1 << 16):
            said += data
    return said


async def trickle(writer: asyncio.StreamWriter, beginning: bytes, period_sec: float) -> None:
    """Send a beginning, and then one byte at a time forever."""
    with contextlib.suppress(*CLOSED):
        writer.write(beginning)
        while True:
            await writer.drain()
            await asyncio.sleep(period_sec)  # noqa: TID251  # that is the attack
            writer.write(b"x")


SLOW = {
    "head": b"GET /topics HTTP/1.1\r\nHost: 127.0.0.1\r\nX-Slow: ",
    "upgrade": b"GET / HTTP/1.1\r\nHost: 127.0.0.1\r\nUpgrade: websocket\r\nSec-WebSocket-Key: ",
    "body": b"POST /topics/x HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: 9999\r\n\r\n",
    "body of the page": b"GET / HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: 9999\r\n\r\n",
    "second head": b"GET /topics HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\nGET /topics HTTP/1.1\r\nX: ",
}


@pytest.mark.parametrize("what", SLOW)
async def test_a_request_that_arrives_byte_by_byte_is_given_up(what: str) -> None:
    """However many bytes arrive: the limit is for the whole request, whether first or later."""
    limits = "handshake_sec = 0.2"
    async with serving(Policy.parse(POLICY + limits)) as gateway, asyncio.TaskGroup() as tasks:
        reader, writer = await asyncio.open_connection("127.0.0.1", gateway.port)
        trickling = tasks.create_task(trickle(writer, SLOW[what], 0.02))
        await closed(reader)
        trickling.cancel()
        writer.close()


async def test_an_idle_connection_is_closed_after_its_answer() -> None:
    """Kept open, it would take the place of a client; a partial header is not a request."""
    request = b"GET /topics HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n"
    limits = "handshake_sec = 0.2"
    async with serving(Policy.parse(POLICY + limits)) as gateway:
        reader, writer = await asyncio.open_connection("127.0.0.1", gateway.port)
        for _ in range(2):
            writer.write(request)
            head = (await reader.readuntil(b"\r\n\r\n")).decode()
            size = int(head.partition("content-length: ")[2].split()[0])
            assert await reader.readexactly(size)
        writer.write(request[:20])
        assert await closed(reader) == b""
        writer.close()


@pytest.mark.slow
async def test_five_hundred_silent_connections_keep_nobody_out() -> None:
    """Their number is limited, and a connection that sends a request replaces the oldest one."""
    limits = "clients = 4\nhandshake_sec = 30.0"
    async with (
        serving(Policy.parse(POLICY + limits)) as gateway,
        raw_connect(gateway, "/", {}, []) as client,
    ):
        slow: list[socket.socket] = []
        for _ in range(25):
            for _ in range(20):
                each = socket.create_connection(("127.0.0.1", gateway.port))
                each.send(SLOW["head"])
                slow.append(each)
            assert (await get(gateway)).status_code == 200
        assert connections_of(gateway) <= 4 + 16 + 1
        op = {"op": "call_service", "service": "/rosapi/get_time"}
        await client.send(json.dumps(op))
        assert json.loads(await client.recv())["op"] == "service_response"
        for each in slow:
            each.close()


async def test_an_answer_that_nobody_reads_is_given_up() -> None:
    """A caller that requests much and reads nothing must not keep a session forever."""
    limits = "handshake_sec = 0.2"
    path = "/topics/words?type=std_msgs/msg/String"
    async with serving(Policy.parse(POLICY + limits)) as gateway:
        words = gateway.node.create_publisher(String, "/words", 10)
        head = f"GET {path} HTTP/1.1\r\nHost: 127.0.0.1\r\nAccept: text/event-stream\r\n\r\n"
        with slow_reader(gateway.port) as caller:
            caller.send(head.encode())
            await until(lambda: gateway.stats.sessions)
            while gateway.stats.sessions:
                words.publish(String(data="x" * 100_000))
                await asyncio.sleep(0.01)  # noqa: TID251  # a topic's rate
            await until(lambda: not connections_of(gateway))


async def test_a_large_answer_has_as_long_as_its_reader_takes() -> None:
    """A slow reader is not an attack: the answer continues as long as some of it is read."""
    limits = "handshake_sec = 0.2"
    size = 400_000
    async with serving(Policy.parse(POLICY + limits)) as gateway:
        words = gateway.node.create_publisher(String, "/words", 1)
        head = "GET /topics/words?type=std_msgs/msg/String HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n"
        with slow_reader(gateway.port) as caller:
            caller.send(head.encode())
            await until(lambda: subscribers_of(gateway))
            words.publish(String(data="x" * size))
            loop, got = asyncio.get_running_loop(), 0
            caller.setblocking(False)
            while got < size:
                await asyncio.sleep(0.02)  # noqa: TID251  # a slow link
                data = await loop.sock_recv(caller, 1 << 16)
                assert data
                got += len(data)


@contextlib.contextmanager
def slow_reader(port: int) -> Any:
    """Connect with a small kernel buffer."""
    with socket.socket() as caller:
        caller.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        caller.connect(("127.0.0.1", port))
        yield caller


async def test_a_client_that_answers_no_pings_is_disconnected_though_it_reads_nothing(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """A frozen page: data waiting for it would keep the connection open if nobody closed it."""
    monkeypatch.setattr("aionode.gateway.server.websocket.PING_SEC", 0.2)
    async with serving(Policy.parse(POLICY)) as gateway:
        words = gateway.node.create_publisher(String, "/words", 10)
        _, writer, _ = await upgraded(gateway)
        writer.transport.pause_reading()  # type: ignore[attr-defined]  # it reads, too
        writer.write(frame(json.dumps({"op": "subscribe", "topic": "/words"}).encode()))
        await until(lambda: subscribers_of(gateway))
        for _ in range(100):
            words.publish(String(data="x" * 100_000))
        await until(lambda: not gateway.stats.sessions)
        await until(lambda: not connections_of(gateway))
        writer.transport.abort()


@pytest.mark.slow
async def test_a_client_that_reads_no_answers_is_disconnected() -> None:
    """It sends requests repeatedly: the waiting answers are limited in size and time."""
    limits = "client_lost_sec = 0.3\nframes_per_sec = 1e6"
    async with serving(Policy.parse(POLICY + limits)) as gateway:
        _, writer, _ = await upgraded(gateway)
        writer.transport.pause_reading()  # type: ignore[attr-defined]  # it reads, too
        await until(lambda: gateway.stats.sessions)
        asking = json.dumps({"op": "call_service", "service": "/rosapi/topics_and_raw_types"})
        with contextlib.suppress(*CLOSED):
            while gateway.stats.sessions and not writer.is_closing():
                writer.write(frame(asking.encode()) * 20)
                await asyncio.sleep(0)  # noqa: TID251  # the gateway has its turn
        await until(lambda: not gateway.stats.sessions)
        writer.transport.abort()


# Bytes designed to be costly


def tiny(kind: str) -> bytes:
    """Return data that takes a parser long: as many parts as fit in 256 kB."""
    if kind == "chunks":
        head = b"POST /topics/x HTTP/1.1\r\nHost: 127.0.0.1\r\nTransfer-Encoding: chunked\r\n\r\n"
        return head + b"1\r\nx\r\n" * 43_000
    beginning, opcode = {"pings": (b"", PING), "frames": (b"", TEXT), "parts": (b"", 0)}[kind]
    if kind == "parts":
        return frame(b"", TEXT, first=0) + frame(b"", 0, first=0) * 43_000
    return frame(beginning, opcode) * 43_000


@pytest.mark.parametrize(
    "kind", ["pings", "frames", "parts", pytest.param("chunks", marks=pytest.mark.slow)]
)
async def test_a_burst_of_tiny_parts_leaves_the_loop_to_the_robot(kind: str) -> None:
    """One read returns 40,000 of them, which take a parser most of a second."""
    data = tiny(kind)
    async with serving(Policy.parse(POLICY)) as gateway:
        if kind == "chunks":
            _, writer = await asyncio.open_connection("127.0.0.1", gateway.port)
        else:
            _, writer, _ = await upgraded(gateway)
            await until(lambda: gateway.stats.sessions)
        async with busiest_turn() as busy:
            writer.write(data)
            await until(lambda: busy.looks > 150)
            longest_sec = busy.longest_sec
        assert longest_sec < 0.1
        writer.transport.abort()


async def test_parts_without_bytes_do_not_pile_up() -> None:
    """A limit in bytes does not count them."""
    async with serving(Policy.parse(POLICY + "frames_per_sec = 1e6")) as gateway:
        reader, writer, _ = await upgraded(gateway)
        with contextlib.suppress(*CLOSED):
            writer.write(frame(b"", TEXT, first=0) + frame(b"", 0, first=0) * 10_001)
            await writer.drain()
        said = await closed(reader)
        # On a busy computer the loop stands still, after which the gateway sends a ping.
        assert re.sub(rb"\x89\x08.{8}", b"", said, flags=re.DOTALL) == b""
        await until(lambda: not gateway.stats.sessions)
        writer.close()


async def test_garbage_that_continues_after_the_goodbye_is_hardly_read(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The gateway waits some seconds for the client's close frame, which may follow later."""
    monkeypatch.setattr("aionode.gateway.rosbridge.client.MAX_MALFORMED", 3)
    read = 0
    take_message = WebSocketConnection.take_message

    def count(self: WebSocketConnection, data: bytes) -> None:
        nonlocal read
        read += 1
        take_message(self, data)

    monkeypatch.setattr(WebSocketConnection, "take_message", count)
    async with serving(Policy.parse(POLICY)) as gateway:
        reader, writer, _ = await upgraded(gateway)
        writer.write(frame(b"garbage") * 4)
        assert (await reader.readexactly(1))[0] == 0x80 | CLOSE
        for _ in range(10):
            writer.write(frame(b"garbage") * 1000)
            await writer.drain()
            await asyncio.sleep(0.01)  # noqa: TID251  # a real connection
        assert read < 300
        writer.transport.abort()


@pytest.mark.parametrize(("limits", "most"), [("", 200), ("frames_per_sec = 100", 100)])
async def test_at_most_two_hundred_pings_a_second_are_read(limits: str, most: int) -> None:
    """Each has to be answered, and must not cost the robot more than a frame of the client."""
    async with serving(Policy.parse(POLICY + limits)) as gateway:
        reader, writer, _ = await upgraded(gateway)
        began = asyncio.get_running_loop().time()
        writer.write(frame(b"", PING) * 2 * most)
        pongs = await reader.readexactly(2 * 2 * most)
        assert pongs == bytes([0x80 | PONG, 0]) * 2 * most
        assert asyncio.get_running_loop().time() - began > 0.2
        writer.close()
