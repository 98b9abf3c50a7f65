"""Large payloads for several subscriptions are copied from Zenoh once, and not kept for long."""

from __future__ import annotations

from typing import Any

from aionode.engine.transport.zenoh.delivery.shared_payload import (
    SHARED_BYTES,
    SharedPayload,
    SharedPayloads,
)

FIRST, SECOND = (b"gid", 1, 10), (b"gid", 2, 20)


class Payload:
    """Counts its copies."""

    def __init__(self, size: int) -> None:
        self.copies = 0
        self._data = b"x" * size

    def to_bytes(self) -> bytes:
        """Return a copy."""
        self.copies += 1
        return self._data


def of(payload: Payload) -> Any:
    """Return a payload as if it were Zenoh's."""
    return payload


def joined(payloads: SharedPayloads, readers: int) -> SharedPayload:
    """Return what a number of subscriptions share."""
    for _ in range(readers - 1):
        payloads.join("key")
    return payloads.join("key")


def test_the_last_subscription_takes_the_payload_with_it() -> None:
    """Nothing is kept for a topic that has become silent."""
    payloads, payload = SharedPayloads(), Payload(SHARED_BYTES)
    shared = joined(payloads, 3)

    for _ in range(3):
        shared.bytes_of(FIRST, of(payload))
    assert payload.copies == 1

    shared.bytes_of(FIRST, of(payload))
    assert payload.copies == 2


def test_the_next_message_replaces_one_that_a_subscription_has_not_taken() -> None:
    """It was dropped there; at most one payload of each key is kept."""
    payloads, first, second = SharedPayloads(), Payload(SHARED_BYTES), Payload(10)
    shared = joined(payloads, 2)

    shared.bytes_of(FIRST, of(first))
    assert len(shared.bytes_of(SECOND, of(second))) == 10
    shared.bytes_of(FIRST, of(first))
    assert first.copies == 2


def test_a_subscription_that_ends_leaves_no_payload() -> None:
    """It would be the last one to take it."""
    payloads, payload = SharedPayloads(), Payload(SHARED_BYTES)
    shared = joined(payloads, 3)
    shared.bytes_of(FIRST, of(payload))

    payloads.leave("key")

    assert shared.readers == 2
    shared.bytes_of(FIRST, of(payload))
    assert payload.copies == 2
