"""A peer that gossip has named once is dialled once."""

from __future__ import annotations

import socket
import time

import zenoh

from tests.zenoh_defects._support import dialling, endpoint, listening, session, sockets, until

ONE_DIALS = {
    "scouting/gossip/autoconnect_strategy": {
        "peer": {"to_router": "always", "to_peer": "greater-zid"}
    }
}
"""One of two peers that gossip introduces dials the other."""


def cut(one: zenoh.Session, other: zenoh.Session) -> None:
    """Cut the connection between two sessions of this process, as a network failure does."""
    ports = {
        (int(str(link.src).rpartition(":")[2]), int(str(link.dst).rpartition(":")[2]))
        for link in one.info.links()
        if str(link.zid) == str(other.zid())
    }
    for here, there, found in sockets():
        if (here, there) in ports:
            found.shutdown(socket.SHUT_RDWR)


def test_a_lost_connection_to_a_peer_that_gossip_has_named_is_not_made_anew() -> None:
    """Both are alive, and connected to the peer that introduced them."""
    hub = endpoint()
    with (
        session(listening(hub)) as introducer,
        session(listening(endpoint()) | dialling(hub) | ONE_DIALS) as one,
        session(listening(endpoint()) | dialling(hub) | ONE_DIALS) as other,
    ):
        ids = {str(each.zid()) for each in (introducer, other)}

        def is_connected() -> bool:
            return ids == {str(transport.zid) for transport in one.info.transports()}

        assert until(is_connected)
        time.sleep(0.5)  # until nobody dials any more
        cut(one, other)
        assert until(lambda: not is_connected())

        assert not until(is_connected, 2.0)
