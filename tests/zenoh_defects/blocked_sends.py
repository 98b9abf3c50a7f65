"""A send that waits for a peer makes others wait that should not."""

from __future__ import annotations

from functools import partial

import zenoh

from tests.zenoh_defects._support import (
    READER,
    WAIT,
    dialling,
    endpoint,
    frozen,
    is_matched,
    process,
    session,
    stands_still,
    until,
)


def test_a_put_with_drop_waits_beside_one_with_block() -> None:
    """It waits for a lock that the other one holds until the peer reads again or is lost."""
    there = endpoint()
    settings = dialling(there) | {WAIT: 3_000_000}
    with process(READER, there) as running, session(settings) as one:
        blocking = one.declare_publisher("a", congestion_control=zenoh.CongestionControl.BLOCK)
        dropping = one.declare_publisher("b", congestion_control=zenoh.CongestionControl.DROP)
        for publisher in (blocking, dropping):
            assert until(partial(is_matched, publisher))

        def fill() -> None:
            for _ in range(400):
                blocking.put(bytes(60_000))

        with frozen(running):
            assert stands_still(fill)
            assert stands_still(lambda: dropping.put(b""))
