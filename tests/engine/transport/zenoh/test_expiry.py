"""Expired messages, which a publisher on Zenoh no longer sends."""

from __future__ import annotations

import pytest

from aionode.engine.transport.zenoh.delivery.expiry import unless_expired
from aionode.engine.wire import _attachment as attachment

GID = bytes(16)


@pytest.mark.parametrize(
    ("lifespan_ns", "now_ns", "is_sent"),
    [(100, 1099, True), (100, 1100, False), (0, 10**18, True)],
    ids=["valid", "expired", "unlimited"],
)
def test_what_has_waited_for_too_long_is_not_sent(
    lifespan_ns: int, now_ns: int, is_sent: bool
) -> None:
    """Its age is known only when its turn comes."""
    sent: list[int] = []
    time_ns = 1000
    send = unless_expired(
        attachment.pack(1, 1000, GID), lifespan_ns, lambda: time_ns, lambda: sent.append(1)
    )
    time_ns = now_ns
    send()
    assert bool(sent) == is_sent
