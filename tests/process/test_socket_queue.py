"""The bytes that wait in a socket."""

from __future__ import annotations

import socket
import sys

import pytest

from aionode._process.socket_queue import unsent_bytes

pytestmark = pytest.mark.skipif(not sys.platform.startswith("linux"), reason="only Linux tells")


def test_a_socket_of_which_the_system_does_not_tell_it_has_no_unsent_bytes() -> None:
    """Sandboxes know the question of none, and a node has to end there as well."""
    one, other = socket.socketpair()
    with one, other:
        one.send(b"unread")

        assert unsent_bytes(one) == 0
