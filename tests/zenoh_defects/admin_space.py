"""A router that answers for its admin space locks its routing table for good."""

from __future__ import annotations

import threading

import zenoh

from tests.zenoh_defects._support import dialling, endpoint, process, session, until

ROUTER = """
settings = {
    "mode": "router",
    "adminspace/enabled": True,
    "adminspace/permissions/read": True,
}
with session(listening(sys.argv[1]) | settings):
    print("open", flush=True)
    threading.Event().wait()
"""


def test_a_router_answers_nobody_any_more() -> None:
    """Its admin space is queried while others declare, for a second at most."""
    there = endpoint()
    client = dialling(there) | {"mode": "client"}
    stopped = threading.Event()
    with (
        process(ROUTER, there) as router,
        session(client) as one,
        session(client) as two,
        session(client) as three,
    ):
        queryable = one.declare_queryable("ping", lambda query: query.reply("ping", b""))
        assert until(lambda: answers(two))

        def declare() -> None:
            number = 0
            while not stopped.is_set():
                number += 1
                keys = [f"k/{threading.get_ident()}/{number}/{each}" for each in range(20)]
                for each in [three.declare_subscriber(key) for key in keys]:
                    each.undeclare()

        def ask() -> None:
            while not stopped.wait(0.001):
                one.get("@/*/router/**", lambda _: None, timeout=1)

        threads = [threading.Thread(target=each, daemon=True) for each in (declare, ask) * 2]
        for thread in threads:
            thread.start()
        is_locked = until(lambda: not answers(two), 3.0)
        stopped.set()
        for thread in threads:
            thread.join(0.2)
        is_locked_still = not answers(two)
        router.kill()
        del queryable

    assert is_locked
    assert is_locked_still


def answers(one: zenoh.Session) -> bool:
    """Return whether a query is answered within half a second."""
    return any(reply.ok is not None for reply in one.get("ping", timeout=0.5))
