"""A lost connection is dialled again before its transport is closed, and may be lost for good."""

from __future__ import annotations

import socket
import time

import zenoh

from tests.zenoh_defects._support import dialling, endpoint, listening, session, sockets, until

REDIAL = {
    "connect/timeout_ms": -1,
    "connect/exit_on_failure": False,
    "connect/retry": {"period_init_ms": 50, "period_max_ms": 50, "period_increase_factor": 1},
    "scouting/gossip/enabled": False,
}

LIMIT_S = 30.0
"""One cut of about a hundred shows it, and there are some fifty in a second."""


def test_a_new_link_becomes_one_of_the_transport_that_is_being_closed() -> None:
    """Two links are added after a cut, but only one transport."""
    there = endpoint()
    port = int(there.rpartition(":")[2])
    links: set[str] = set()
    transports = 0

    def take_link(event: zenoh.LinkEvent) -> None:
        if event.kind == zenoh.SampleKind.PUT:
            links.add(str(event.link.src))

    def take_transport(event: zenoh.TransportEvent) -> None:
        nonlocal transports
        transports += event.kind == zenoh.SampleKind.PUT

    with (
        session(listening(there)),
        session(dialling(there) | REDIAL) as one,
        one.info.declare_link_events_listener(take_link),
        one.info.declare_transport_events_listener(take_transport),
    ):
        ends_s = time.perf_counter() + LIMIT_S
        is_shown = False
        while not is_shown and time.perf_counter() < ends_s:
            assert until(one.info.links)
            old = {str(link.src) for link in one.info.links()}
            transports = 0
            for _, remote, ours in sockets():
                if remote == port:
                    ours.shutdown(socket.SHUT_RDWR)
            assert until(lambda: links - old and transports)  # noqa: B023  # called at once
            time.sleep(0.01)
            if len(links - old) > transports:
                time.sleep(0.5)  # the event of a transport may be late
                is_shown = len(links - old) > transports
            links.clear()

    assert is_shown
