"""A connection that is given up at the wrong moment stays for good, and is never read."""

from __future__ import annotations

import threading
import time
from contextlib import suppress

import zenoh

from tests.zenoh_defects._support import dialling, endpoint, listening, session, until

LIMIT_S = 4.5


def test_a_connection_that_was_given_up_may_be_deaf() -> None:
    """This happens to some of many that are given up after a millisecond or two."""
    there = endpoint()
    deaf = threading.Event()
    ends_s = time.perf_counter() + LIMIT_S

    def dial(open_ms: int) -> None:
        settings = dialling(there) | {
            "transport/unicast/open_timeout": open_ms,
            "connect/timeout_ms": 0,
            "connect/exit_on_failure": False,
            "open/return_conditions/connect_scouted": False,
        }
        while not deaf.is_set() and time.perf_counter() < ends_s:
            with suppress(zenoh.ZError), session(settings) as one:
                if until(one.info.links, 0.05) and not sees_token(one) and not sees_token(one):
                    deaf.set()

    with session(listening(there)) as other:
        token = other.liveliness().declare_token("t")
        threads = [threading.Thread(target=dial, args=(1 + number % 3,)) for number in range(6)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        token.undeclare()

    assert deaf.is_set()


def sees_token(one: zenoh.Session) -> bool:
    """Return whether a session sees the token of the other one."""
    return any(reply.ok is not None for reply in one.liveliness().get("t", timeout=0.3))
