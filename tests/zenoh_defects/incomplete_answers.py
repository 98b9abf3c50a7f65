"""The answer of a peer that is connected to a router lacks tokens of the peer itself."""

from __future__ import annotations

from tests.zenoh_defects._support import dialling, endpoint, listening, session, until

COUNT = 300


def test_an_answer_of_a_peer_beside_a_router_may_lack_its_own_tokens() -> None:
    """One of ten did, or more."""
    hub, there = endpoint(), endpoint()
    with (
        session(listening(hub) | {"mode": "router"}),
        session(listening(there) | dialling(hub)) as peer,
        session(dialling(there) | {"mode": "client"}) as client,
    ):
        tokens = [peer.liveliness().declare_token(f"t/{number}") for number in range(COUNT)]

        def is_incomplete() -> bool:
            return (
                sum(reply.ok is not None for reply in client.liveliness().get("t/*", timeout=4))
                < COUNT
            )

        assert until(lambda: not is_incomplete())
        assert until(is_incomplete)
        del tokens
