"""Many rosbridge clients in one process, which take next to no processor time.

``python reader.py OPTIONS``, where OPTIONS are JSON: ``port``; ``clients``, their number;
``subscribe``, the op with which each of them begins; ``last``, the number of the last message;
``deaf``, how many further ones subscribe and then read nothing; ``wait_sec``, the time without any
message after which it gives up.

Each message has a number: the first one in it, or the seconds of a stamp at its beginning. It
prints ``ready`` when every client has received one, and JSON at the end: for each client how many
of the numbers up to the last one are missing, duplicated, and out of order. With ``count`` instead
of ``last``, messages have no numbers: it prints ``ready`` when all are connected, and then how many
of that many messages each client lacks. It uses neither aionode nor a WebSocket library, which
would take more time than the gateway.
"""

from __future__ import annotations

import json
import re
import selectors
import socket
import sys
from collections.abc import Callable
from typing import Any

CHUNK = bytearray(1 << 20)
NUMBER = re.compile(rb'"data":"?(\d+)|"sec":(\d+)')
BYTES = b"\x65bytes\x5a"
"""The last key of a frame of cbor-raw, and the kind of its value, whose length follows."""

BEGINNING = 512
"""The number of bytes at the beginning of a message that contain its number."""

REQUEST = (
    "GET / HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
    "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n\r\n"
)
MASK = b"\0\0\0\0"
"""The key that masks a client's frames; zeros change nothing."""

TEXT, PING, PONG = 0x81, 0x89, 0x8A


def frame_of(text: str) -> bytes:
    """Return a frame of a client."""
    data = text.encode()
    if len(data) < 126:
        head = bytes((TEXT, 0x80 | len(data)))
    else:
        head = bytes((TEXT, 0xFE)) + len(data).to_bytes(2, "big")
    return head + MASK + data


def opened(port: int, receive_bytes: int = 0) -> socket.socket:
    """Return the socket of a new WebSocket."""
    connection = socket.socket()
    if receive_bytes:
        connection.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, receive_bytes)
    connection.connect(("127.0.0.1", port))
    connection.sendall(REQUEST.format(port=port).encode())
    answer = b""
    while b"\r\n\r\n" not in answer:
        answer += connection.recv(1)
    if b" 101 " not in answer:
        sys.exit(f"refused: {answer!r}")
    return connection


class Client:
    """A client: splits frames, and records the numbers of messages."""

    def __init__(self, port: int, subscribe: str) -> None:
        self.socket = opened(port)
        self.socket.sendall(frame_of(subscribe))
        self.numbers: list[int] = []
        self.count = 0
        self._begun = bytearray()  # the beginning of a frame: its header, and of its payload
        self._skip = 0  # how much of the frame is still to come, without a number in it

    def take(self) -> int:
        """Process arrived data, and return its size; 0 at the end of the connection."""
        size = self.socket.recv_into(CHUNK)
        at = min(self._skip, size)
        self._skip -= at
        if at == size:
            return size
        data = bytes(self._begun) + CHUNK[at:size] if self._begun else CHUNK[at:size]
        self._begun.clear()
        at = 0
        while at < len(data):
            end, payload = self._frame(data, at)
            if end is None:
                self._begun += data[at:]
                break
            self._note(data[at], bytes(data[payload : min(end, payload + BEGINNING)]))
            if end > len(data):
                self._skip = end - len(data)
                break
            at = end
        return size

    def _frame(self, data: Any, at: int) -> tuple[int | None, int]:
        """Return where a frame ends and its payload begins; None if too little has arrived."""
        there = len(data) - at
        if there < 2:
            return None, 0
        length, head = data[at + 1], 2
        if length > 125:
            head = 4 if length == 126 else 10
            if there < head:
                return None, 0
            length = int.from_bytes(data[at + 2 : at + head], "big")
        if there < head + min(length, BEGINNING):
            return None, 0
        return at + head + length, at + head

    def _note(self, first: int, beginning: bytes) -> None:
        if first & 0x0F > 2:
            if first == PING:
                self.socket.sendall(bytes((PONG, 0x80 | len(beginning))) + MASK + beginning)
            return
        self.count += 1
        found = NUMBER.search(beginning)
        if found is not None:
            self.numbers.append(int(found[1] or found[2]))
        elif (at := beginning.find(BYTES)) >= 0:
            body = at + len(BYTES) + 4 + 4  # the length, and the head of CDR
            self.numbers.append(int.from_bytes(beginning[body : body + 4], "little"))

    def verdict(self, last: int) -> list[int]:
        """Return how many numbers are missing, duplicated, and out of order."""
        counted = [number for number in self.numbers if number > 0]
        different = len(set(counted))
        in_order = sum(b < a for a, b in zip(self.numbers, self.numbers[1:], strict=False))
        return [last - different, len(counted) - different, in_order]


def main(options: dict[str, Any]) -> None:
    """Read until every client has the last message."""
    subscribe = json.dumps(options["subscribe"])
    deaf = [opened(options["port"], 4096) for _ in range(options.get("deaf", 0))]
    for each in deaf:
        each.sendall(frame_of(json.dumps(options["subscribe"] | {"queue_length": 10})))
    clients = [Client(options["port"], subscribe) for _ in range(options["clients"])]
    if "count" in options:
        print("ready", flush=True)
        read(clients, lambda client: client.count >= options["count"], options)
        verdicts = [[options["count"] - client.count] for client in clients]
    else:
        read(clients, lambda client: client.numbers[-1:] == [options["last"]], options)
        verdicts = [client.verdict(options["last"]) for client in clients]
    print(json.dumps(verdicts), flush=True)
    sys.stdin.read()  # the connections last until their counts have been read


def read(clients: list[Client], has_all: Callable[[Client], bool], options: dict[str, Any]) -> None:
    """Read until every client has everything, or nothing has arrived for some time."""
    selector = selectors.DefaultSelector()
    for client in clients:
        selector.register(client.socket, selectors.EVENT_READ, client)
    without = set() if "count" in options else set(clients)  # any message so far
    unfinished = set(clients)
    while unfinished and (events := selector.select(options.get("wait_sec", 5.0))):
        for key, _ in events:
            client = key.data
            if not client.take():
                unfinished.discard(client)
                selector.unregister(key.fileobj)
            elif client.numbers and client in without:
                without.discard(client)
                if not without:
                    print("ready", flush=True)
            if has_all(client):
                unfinished.discard(client)


if __name__ == "__main__":
    main(json.loads(sys.argv[1]))
