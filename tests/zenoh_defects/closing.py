"""Closing a session waits for peers that read nothing, or do not answer."""

from __future__ import annotations

import socket
from functools import partial

import zenoh

from tests.zenoh_defects._support import (
    READER,
    dialling,
    endpoint,
    frozen,
    is_matched,
    is_stuck,
    opened,
    process,
    stands_still,
    until,
)

CLOSES = """
one = opened({
    **dialling(sys.argv[1]),
    "connect/timeout_ms": -1,
    "connect/exit_on_failure": False,
    "open/return_conditions/connect_scouted": False,
})
print("open", flush=True)
sys.stdin.readline()
print(stands_still(one.close, 2.0), flush=True)
os._exit(0)
"""


def test_close_waits_for_a_peer_that_does_not_answer() -> None:
    """The operating system of that peer has accepted the connection."""
    with (
        socket.create_server(("127.0.0.1", 0)) as silent,
        process(CLOSES, f"tcp/127.0.0.1:{silent.getsockname()[1]}") as running,
    ):
        accepted, _ = silent.accept()
        with accepted:
            assert running.stdin is not None
            assert running.stdout is not None
            assert accepted.recv(1)
            running.stdin.write("\n")
            running.stdin.flush()

            assert running.stdout.readline() == "True\n"


def test_close_waits_for_a_peer_that_takes_nothing() -> None:
    """The messages in its socket were sent with DROP."""
    there = endpoint()
    port = int(there.rpartition(":")[2])
    with process(READER, there) as running:
        one = opened(dialling(there))
        publisher = one.declare_publisher("a", congestion_control=zenoh.CongestionControl.DROP)
        assert until(partial(is_matched, publisher))
        with frozen(running):
            while not is_stuck(port):
                for _ in range(100):
                    publisher.put(bytes(60_000))

            assert stands_still(one.close, 2.0)
        running.kill()
        assert until(one.is_closed)
