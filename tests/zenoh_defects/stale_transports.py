"""A peer that reconnects to a process that has not noticed the loss receives no declarations."""

from __future__ import annotations

import socket
import threading
from contextlib import suppress

from tests.zenoh_defects._support import dialling, endpoint, listening, session, until

REDIAL = {
    "connect/timeout_ms": -1,
    "connect/exit_on_failure": False,
    "connect/retry": {"period_init_ms": 50, "period_max_ms": 50, "period_increase_factor": 1},
    "scouting/gossip/enabled": False,
}


class Road:
    """A way to a port of this machine, whose ends can be closed one by one."""

    def __init__(self, there: str) -> None:
        self._port = int(there.rpartition(":")[2])
        self._listener = socket.create_server(("127.0.0.1", 0))
        self.endpoint = f"tcp/127.0.0.1:{self._listener.getsockname()[1]}"
        self.ends: list[tuple[socket.socket, socket.socket]] = []
        threading.Thread(target=self._accept, daemon=True).start()

    def _accept(self) -> None:
        while True:
            near, _ = self._listener.accept()
            try:
                far = socket.create_connection(("127.0.0.1", self._port))
            except OSError:  # nobody listens there yet
                near.close()
                continue
            self.ends.append((near, far))
            for source, target in ((near, far), (far, near)):
                threading.Thread(target=copy, args=(source, target), daemon=True).start()


def copy(source: socket.socket, target: socket.socket) -> None:
    """Pass on what comes; not the end."""
    with suppress(OSError):
        while data := source.recv(65536):
            target.sendall(data)


def test_one_that_has_not_noticed_the_loss_declares_nothing_to_one_that_reconnects() -> None:
    """They dial each other, so that their transport has two links.

    One loses both, the other only one: the link on which the first dials again is taken for another
    one of the old transport.
    """
    ours, theirs = endpoint(), endpoint()
    to_them, to_us = Road(theirs), Road(ours)
    with (
        session(listening(ours) | dialling(to_them.endpoint) | REDIAL) as one,
        session(listening(theirs) | dialling(to_us.endpoint) | REDIAL) as other,
    ):
        token = other.liveliness().declare_token("t")

        def sees_token() -> bool:
            return any(reply.ok is not None for reply in one.liveliness().get("t", timeout=0.5))

        assert until(lambda: len(one.info.links()) == len(other.info.links()) == 2)
        assert until(sees_token)
        count = len(to_them.ends)
        _, ours_end = to_us.ends[-1]
        for end in (*to_them.ends[-1], ours_end):
            end.shutdown(socket.SHUT_RDWR)
        assert until(lambda: len(to_them.ends) > count)
        assert until(lambda: len(one.info.transports()) == 1 == len(other.info.transports()))

        assert not until(sees_token, 2.0)
        token.undeclare()
