"""A new message that overtakes a late publisher's history replaces it."""

from __future__ import annotations

import socket
import threading
from contextlib import suppress

import pytest
from zenoh import ext

from tests.zenoh_defects._support import dialling, endpoint, is_matched, listening, session, until

LATE = {
    "connect/timeout_ms": -1,
    "connect/exit_on_failure": False,
    "connect/retry": {"period_init_ms": 50, "period_max_ms": 50, "period_increase_factor": 1},
    "open/return_conditions/connect_scouted": False,
    "timestamping/enabled": True,
}


@pytest.mark.parametrize(("news", "arriving"), [([], ["1", "2"]), (["3"], ["3"])])
def test_a_message_published_before_the_answer_replaces_the_history(
    news: list[str], arriving: list[str]
) -> None:
    """It is under way together with the publisher's token, which makes the subscriber ask."""
    there, via = endpoint(), endpoint()
    arrived: list[str] = []
    with session(listening(there)) as reader, session(dialling(via) | LATE) as writer:
        subscriber = ext.declare_advanced_subscriber(
            reader,
            "a",
            lambda sample: arrived.append(sample.payload.to_string()),
            history=ext.HistoryConfig(detect_late_publishers=True, max_samples=10),
        )
        publisher = ext.declare_advanced_publisher(
            writer,
            "a",
            cache=ext.CacheConfig(max_samples=10),
            publisher_detection=True,
            sample_miss_detection=ext.MissDetectionConfig(heartbeat=None, sporadic_heartbeat=None),
        )
        with writer.declare_publisher("a") as plain:
            for text in ("1", "2"):
                publisher.put(text)
            go_on = relay(via, there)
            assert until(lambda: is_matched(plain))
            for text in news:
                publisher.put(text)
            go_on.set()

            assert until(lambda: arrived == arriving)
            assert not until(lambda: arrived != arriving, 0.5)
        del subscriber


def relay(via: str, there: str) -> threading.Event:
    """Connect whoever dials `via` with `there`; what it sends after two messages waits."""
    go_on = threading.Event()
    listener = socket.create_server(("127.0.0.1", port_of(via)))

    def run() -> None:
        with (
            listener,
            listener.accept()[0] as one,
            socket.create_connection(("127.0.0.1", port_of(there))) as other,
            one.makefile("rb") as arriving,
        ):
            threading.Thread(target=pass_on, args=(other, one), daemon=True).start()
            for _ in range(2):  # Zenoh's opening messages, after their sizes
                size = arriving.read(2)
                other.sendall(size + arriving.read(int.from_bytes(size, "little")))
            go_on.wait(4)
            while data := arriving.read1():
                other.sendall(data)

    threading.Thread(target=run, daemon=True).start()
    return go_on


def pass_on(one: socket.socket, other: socket.socket) -> None:
    """Pass on what arrives until either end is closed."""
    with suppress(OSError):
        while data := one.recv(65536):
            other.sendall(data)


def port_of(there: str) -> int:
    """Return the port of an endpoint."""
    return int(there.rpartition(":")[2])
