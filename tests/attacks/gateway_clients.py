"""Attacks of clients on a gateway, which need no Zenoh session.

Each is called with its duration in seconds and the process ids of the nodes, one of which has a
gateway; it returns the number of attempts.
"""

from __future__ import annotations

import itertools
import json
import os
import signal
import socket
import struct
import time
import urllib.request
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress
from functools import partial
from http.client import HTTPConnection

import psutil
from websockets.sync.client import connect

__all__ = ["GATEWAY_PROGRAMS"]

SIZE = 990_000
"""As much as fits into a frame."""

UPGRADE = (
    b"GET / HTTP/1.1\r\nHost: 127.0.0.1\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
    b"Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\nSec-WebSocket-Version: 13\r\n\r\n"
)
POST = (
    b"POST /topics/t?type=geometry_msgs/PoseArray HTTP/1.1\r\nHost: 127.0.0.1\r\n"
    b"Content-Type: application/json\r\n"
)
TEXT, PING = 1, 9

Attack = Callable[[int, float], int]


def begun() -> None:
    """Tell that the attack begins."""
    print("begun", flush=True)  # noqa: T201 - a program


def gateway_of(pids: Sequence[int]) -> tuple[int, int]:
    """Return the process and port of the gateway: the one whose health check answers."""
    for pid in pids:
        for each in psutil.Process(pid).net_connections(kind="tcp"):
            if each.status != psutil.CONN_LISTEN:
                continue
            with suppress(OSError, ValueError):
                url = f"http://127.0.0.1:{each.laddr.port}/healthz"
                with urllib.request.urlopen(url, timeout=1.0) as answer:  # of this host
                    if b"ok" in answer.read():
                        return pid, int(each.laddr.port)
    raise RuntimeError("none of the processes has a gateway")


def against_gateway(attack: Attack, seconds: float, pids: Sequence[int]) -> int:
    """Run an attack against the port of the gateway."""
    _, port = gateway_of(pids)
    begun()
    return attack(port, time.monotonic() + seconds)


def frame(payload: bytes, opcode: int = TEXT, first: int = 0x80) -> bytes:
    """Return a frame of a client, masked with zeros."""
    size = len(payload)
    if size < 126:
        length = bytes([0x80 | size])
    elif size < 1 << 16:
        length = struct.pack(">BH", 0x80 | 126, size)
    else:
        length = struct.pack(">BQ", 0x80 | 127, size)
    return bytes([first | opcode]) + length + bytes(4) + payload


def websocket(port: int) -> socket.socket:
    """Begin a WebSocket."""
    made = socket.create_connection(("127.0.0.1", port), timeout=2.0)
    made.sendall(UPGRADE)
    made.recv(4096)
    return made


def bombs() -> Iterator[bytes]:
    """Yield JSON values that are expensive to process, in one frame each."""
    for values in itertools.cycle(
        (
            '{"poses":[' + "{}," * (SIZE // 3) + "{}]}",
            '{"poses":[' + "{}," * 4_900 + "{}]}",
            "[" * SIZE,
            "[NaN," + "[]," * (SIZE // 3) + "[]]",
            '{"header":' * 1_000 + "1" + "}" * 1_000,
            '{"poses":' + "1" * SIZE + "}",
            '{"' + "x" * SIZE + '":1}',
            '{"header":{"frame_id":"' + "\\u0041" * (SIZE // 6) + '"}}',
        )
    ):
        yield values.encode()


def send_bombs(port: int, until: float) -> int:
    """Send bombs over WebSockets and HTTP in turns, each once the previous one was accepted."""
    tries = 0
    for values in bombs():
        if time.monotonic() > until:
            return tries
        tries += 1
        with suppress(OSError):
            if tries % 2:
                op = b'{"op":"publish","topic":"/t","type":"geometry_msgs/PoseArray","msg":'
                with websocket(port) as client:
                    client.sendall(frame(op + values + b"}"))
                    client.sendall(frame(b"", PING))
                    client.recv(4096)
            else:
                with socket.create_connection(("127.0.0.1", port), timeout=2.0) as client:
                    client.sendall(POST + b"Content-Length: %d\r\n\r\n" % len(values) + values)
                    client.recv(4096)
    return tries


def send_tiny_parts(port: int, until: float) -> int:
    """Send pings, empty frames, empty parts and one-byte chunks, as fast as they are accepted."""
    kinds = (
        (UPGRADE, frame(b"", PING) * 10_000),
        (UPGRADE, frame(b"") * 10_000),
        (UPGRADE + frame(b"", TEXT, 0), frame(b"", 0, 0) * 10_000),
        (POST + b"Transfer-Encoding: chunked\r\n\r\n", b"1\r\nx\r\n" * 10_000),
    )
    tries = 0
    for beginning, data in itertools.cycle(kinds):
        if time.monotonic() > until:
            return tries
        with suppress(OSError), socket.create_connection(("127.0.0.1", port), 0.3) as client:
            client.sendall(beginning)
            for _ in range(10):
                client.sendall(data)
                tries += 10_000
    return tries


def keep_waiting(port: int, until: float) -> int:
    """Keep 500 connections that send a byte at a time, and open new ones for those that close."""
    beginnings = itertools.cycle(
        (
            b"",
            b"GET /topics HTTP/1.1\r\nX-Slow: ",
            UPGRADE[:60],
            POST + b"Content-Length: 9999\r\n\r\n",
        )
    )
    kept: list[socket.socket] = []
    tries = 0
    while time.monotonic() < until:
        while len(kept) < 500:
            with suppress(OSError):
                each = socket.create_connection(("127.0.0.1", port), timeout=0.5)
                each.sendall(next(beginnings))
                kept.append(each)
                tries += 1
        for each in list(kept):
            try:
                each.sendall(b"x")
            except OSError:
                kept.remove(each)
        time.sleep(0.1)
    return tries


def read_nothing(port: int, until: float) -> int:
    """Subscribe and request a lot with 20 clients, and read nothing."""
    asking = frame(b'{"op":"subscribe","topic":"/chatter"}')
    asking += frame(b'{"op":"call_service","service":"/rosapi/topics_and_raw_types"}') * 200
    clients = [websocket(port) for _ in range(20)]
    tries = 0
    while time.monotonic() < until:
        for client in clients:
            with suppress(OSError):
                client.settimeout(0.01)
                client.sendall(asking)
                tries += 1
    return tries


def guess_tokens(port: int, until: float) -> int:
    """Try tokens as fast as they are checked."""
    tries = 0
    while time.monotonic() < until:
        with suppress(OSError), socket.create_connection(("127.0.0.1", port), 2.0) as client:
            for _ in range(100):
                client.sendall(
                    b"GET /topics HTTP/1.1\r\nHost: 127.0.0.1\r\nAuthorization: Bearer %d\r\n\r\n"
                    % tries
                )
                if not client.recv(4096):
                    break
                tries += 1
    return tries


def drive_twice(port: int, until: float) -> int:
    """Drive over two connections of one identity, which must not both be obeyed.

    Raises:
        RuntimeError: both were obeyed.
    """
    drivers = [HTTPConnection("127.0.0.1", port, timeout=5.0) for _ in range(2)]
    tries = 0
    while time.monotonic() < until:
        codes = []
        for each in drivers:
            headers = {"Content-Type": "application/json"}
            path = "/topics/cmd_vel?type=geometry_msgs/Twist"
            each.request("POST", path, '{"linear": {"x": 0.1}}', headers)
            answer = each.getresponse()
            answer.read()
            codes.append(answer.status)
        if codes == [204, 204]:
            raise RuntimeError("two programs of one identity drive at once")
        tries += 1
        time.sleep(0.02)
    return tries


OLD_S = 1.0
"""How old a command may be when the wheels hear it: what the policy allows, and some time to get
there."""


LISTENS_S = 4.0
"""How long nothing more is sent at the end, while what waits would be worked off."""


def drive_late(port: int, until: float) -> int:
    """Make the gateway refuse so much that later frames wait, and send commands behind it.

    Raises:
        RuntimeError: an old command reached the wheels.
    """
    url = f"ws://127.0.0.1:{port}"
    tries = 0
    with connect(url, proxy=None) as driver, connect(url, proxy=None) as wheels:
        topic = {"topic": "/cmd_vel", "type": "geometry_msgs/Twist"}
        wheels.send(json.dumps({"op": "subscribe", **topic}))
        while time.monotonic() < until:
            if time.monotonic() < until - LISTENS_S:
                for speed in ("NaN", time.monotonic()) * 10:
                    command = {"linear": {"x": speed}}
                    driver.send(json.dumps({"op": "publish", **topic, "msg": command}))
                    tries += 1
            with suppress(TimeoutError):
                while True:
                    heard = json.loads(wheels.recv(timeout=0.02))["msg"]["linear"]["x"]
                    late_s = time.monotonic() - heard
                    if heard and late_s > OLD_S:
                        raise RuntimeError(f"a command of {late_s:.1f} s ago moves the wheels")
    return tries


def drive_frozen(seconds: float, pids: Sequence[int]) -> int:
    """Suspend the gateway repeatedly for 0.8 s, and drive only in the first half of that.

    Raises:
        RuntimeError: a command reached the wheels afterwards.
    """
    pid, port = gateway_of(pids)
    begun()
    url = f"ws://127.0.0.1:{port}"
    until, tries = time.monotonic() + seconds, 0
    topic = {"topic": "/cmd_vel", "type": "geometry_msgs/Twist"}
    with connect(url, proxy=None) as driver, connect(url, proxy=None) as wheels:
        wheels.send(json.dumps({"op": "subscribe", **topic}))
        time.sleep(0.5)
        while time.monotonic() < until:
            os.kill(pid, signal.SIGSTOP)
            try:
                for _ in range(20):
                    command = {"linear": {"x": 1.0}}
                    driver.send(json.dumps({"op": "publish", **topic, "msg": command}))
                    tries += 1
                    time.sleep(0.02)
                time.sleep(0.4)
            finally:
                os.kill(pid, signal.SIGCONT)
            with suppress(TimeoutError):
                wheels.recv(timeout=0.7)
                raise RuntimeError("a command from a standstill moves the wheels")
    return tries


def take_all_places(port: int, until: float) -> int:
    """Keep as many WebSockets, streams and pending requests open as one identity may.

    Raises:
        RuntimeError: a client of another identity is refused.
    """
    kept: list[socket.socket] = []
    stream = (
        b"GET /topics/none?type=std_msgs/String&timeout_sec=600 HTTP/1.1\r\nHost: 127.0.0.1\r\n"
    )
    token = b"Authorization: Bearer viewer\r\n"
    beginnings = itertools.cycle(
        (
            UPGRADE.replace(b"\r\n\r\n", b"\r\n" + token + b"\r\n"),
            stream + token + b"\r\n",
            stream + token + b"Accept: text/event-stream\r\n\r\n",
        )
    )
    tries = 0
    while time.monotonic() < until:
        for _ in range(30):
            with suppress(OSError):
                each = socket.create_connection(("127.0.0.1", port), timeout=0.5)
                each.sendall(next(beginnings))
                kept.append(each)
                tries += 1
        time.sleep(0.1)
        check_client(port, "operator")
        check_client(port, "admin")
        while len(kept) > 150:
            kept.pop(0).close()
    return tries


def load_images(port: int, until: float) -> int:
    """Act as a page of another origin, whose images have wrong tokens in their addresses.

    Raises:
        RuntimeError: the operator's own token is refused.
    """
    headers = ({"Origin": "http://evil.example"}, {"Sec-Fetch-Site": "cross-site"},
               {"User-Agent": "Mozilla/5.0"}, {"Host": "evil.example"})  # fmt: skip
    tries = 0
    while time.monotonic() < until:
        for each in headers:
            page = HTTPConnection("127.0.0.1", port, timeout=5.0)
            for _ in range(14):
                page.request("GET", f"/topics/camera.jpeg?token={tries}", headers=each)
                page.getresponse().read()
                tries += 1
            page.close()
        check_client(port, "operator")
    return tries


def read_hidden(port: int, until: float) -> int:
    """Ask for a parameter that the policy hides, by each service that reveals parameters.

    Raises:
        RuntimeError: one of them revealed it.
    """
    tries = 0
    headers = {"Content-Type": "application/json", "Authorization": "Bearer viewer"}
    client = HTTPConnection("127.0.0.1", port, timeout=5.0)
    asked = json.dumps({"names": ["large"]})
    services = {"get_parameters": asked, "get_parameter_types": asked,
                "describe_parameters": asked, "list_parameters": "{}"}  # fmt: skip
    while time.monotonic() < until:
        for service, body in services.items():
            client.request("POST", f"/services/talker/{service}", body, headers)
            answer = client.getresponse()
            text = answer.read().decode()
            if answer.status == 200 and (service != "list_parameters" or "large" in text):
                raise RuntimeError(f"{service} tells of a parameter that is hidden: {text[:200]}")
            tries += 1
    return tries


def check_client(port: int, token: str) -> None:
    """Send a request as the client with a token.

    Raises:
        RuntimeError: it is refused.
    """
    client = HTTPConnection("127.0.0.1", port, timeout=5.0)
    client.request("GET", "/nodes", headers={"Authorization": f"Bearer {token}"})
    status = client.getresponse().status
    client.close()
    if status != 200:
        raise RuntimeError(f"the client with the token {token!r} is refused with {status}")


GATEWAY_PROGRAMS = {
    attack.__name__: partial(against_gateway, attack)
    for attack in (
        send_bombs,
        send_tiny_parts,
        keep_waiting,
        read_nothing,
        guess_tokens,
        drive_twice,
        drive_late,
        take_all_places,
        load_images,
        read_hidden,
    )
} | {"drive_frozen": drive_frozen}
