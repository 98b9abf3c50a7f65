"""Closing a socket may wait ten seconds for a peer that reads nothing."""

from __future__ import annotations

import socket
import struct

from tests.zenoh_defects._support import dialling, endpoint, listening, session, sockets, until


def lingers(port: int) -> set[tuple[int, int]]:
    """Return SO_LINGER of all connections of this process to a port."""
    return {
        struct.unpack("ii", one.getsockopt(socket.SOL_SOCKET, socket.SO_LINGER, 8))
        for here, there, one in sockets()
        if port in {here, there}
    }


def test_each_connection_lingers_for_ten_seconds() -> None:
    """Both that of the end that dials, and that of the end that listens."""
    there = endpoint()
    with session(listening(there)), session(dialling(there)) as one:
        assert until(one.info.links)

        assert lingers(int(there.rpartition(":")[2])) == {(1, 10)}
