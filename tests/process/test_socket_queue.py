"""The bytes that wait in a socket."""

from __future__ import annotations

import socket
import sys

import pytest

from aionode._process.socket_queue import queued_bytes, unsent_bytes

pytestmark = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="only Linux tells")


def test_bytes_count_as_unsent_until_acknowledged_where_the_system_does_not_tell_more() -> None:
    """A sandbox, in which a node has to end beside a frozen peer as well."""
    one, other = socket.socketpair()  # of which the system knows no unsent bytes
    with one, other:
        one.send(b"unread")

        assert unsent_bytes(one) == queued_bytes(one) > 0
