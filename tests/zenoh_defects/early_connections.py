"""A connection is reported before the session uses it."""

from __future__ import annotations

import threading

import zenoh

from tests.zenoh_defects._support import dialling, endpoint, listening, session, until


def test_a_query_lacks_the_tokens_of_a_peer_whose_connection_is_reported() -> None:
    """The thread that reports it is held meanwhile."""
    there = endpoint()
    is_reported, may_go_on = threading.Event(), threading.Event()

    def hold(_: zenoh.TransportEvent) -> None:
        is_reported.set()
        may_go_on.wait(4)

    with session(listening(there)) as one:
        handler = zenoh.handlers.Callback(hold, indirect=False)
        with one.info.declare_transport_events_listener(handler):
            opening = threading.Thread(target=declare, args=(there, may_go_on))
            opening.start()
            assert is_reported.wait(4)

            assert one.info.transports()
            assert not list(one.liveliness().get("t", timeout=1))
            may_go_on.set()
            assert until(lambda: list(one.liveliness().get("t", timeout=1)))
            opening.join()


def declare(there: str, until_then: threading.Event) -> None:
    """Declare a token in another session for a while."""
    quiet = {"open/return_conditions/connect_scouted": False}
    with session(dialling(there) | quiet) as peer, peer.liveliness().declare_token("t"):
        until_then.wait(4)
        until(lambda: False, 1)
