"""Limits, sizes, QoS and attachments that publishers, subscriptions and services share."""

from __future__ import annotations

import logging
from typing import TYPE_CHECKING

import zenoh

from aionode.engine.transport.base import SampleInfo
from aionode.engine.transport.zenoh._defects.blocked_sends import BLOCK_US
from aionode.engine.transport.zenoh.connections.handlers import BULK_PRIORITY, DROP, reason
from aionode.engine.transport.zenoh.session.settings import FLUSH_S
from aionode.engine.wire._attachment import unpack_fields
from aionode.qos import DurabilityPolicy, ReliabilityPolicy

if TYPE_CHECKING:
    from zenoh import ext

    from aionode.qos import QoSProfile

__all__ = [
    "FLUSH_NS",
    "GIVEN_UP_NS",
    "STILL_NS",
    "UNKNOWN_GID",
    "is_reliable",
    "is_transient",
    "sample_info_of",
    "send_bulk",
    "withdraw",
]

logger = logging.getLogger("aionode.transport.zenoh")

UNKNOWN_GID = bytes(16)
"""The gid of a message without a valid attachment."""

FLUSH_NS = int(FLUSH_S * 1e9)
"""How long a destroyed publisher waits for acknowledgements while there is progress."""

STILL_NS = 500_000_000
"""How long it waits without progress."""

GIVEN_UP_NS = BLOCK_US * 900
"""Duration from which a send counts as given up by Zenoh."""


def is_reliable(qos: QoSProfile) -> bool:
    """Return whether lost messages are resent."""
    return qos.resolved().reliability is ReliabilityPolicy.RELIABLE


def is_transient(qos: QoSProfile) -> bool:
    """Return whether late subscriptions get what was published before."""
    return qos.durability is DurabilityPolicy.TRANSIENT_LOCAL


def sample_info_of(extra: zenoh.ZBytes | None) -> SampleInfo | None:
    """Parse an attachment; return None if it is missing or its format is unknown."""
    if extra is None:
        return None
    fields = unpack_fields(extra.to_bytes())
    return None if fields is None else SampleInfo(fields[2], fields[0], fields[1])


def send_bulk(
    sender: zenoh.Session | zenoh.Publisher | ext.AdvancedPublisher,
    key: str,
    payload: bytes,
    extra: bytes,
) -> None:
    """Send a message from a thread, with the priority of large ones if the session is open.

    No caller waits, so an error (after the session was closed) is logged.
    """
    try:
        if isinstance(sender, zenoh.Session):
            sender.put(
                key,
                payload,
                attachment=extra,
                congestion_control=DROP,
                priority=BULK_PRIORITY,
                allowed_destination=zenoh.Locality.REMOTE,
            )
        else:
            sender.put(payload, attachment=extra)
    except zenoh.ZError as error:
        logger.debug("%s: not sent: %s", key, reason(error))


def withdraw(publisher: zenoh.Publisher | ext.AdvancedPublisher) -> None:
    """Undeclare a publisher, unless its session has already been closed."""
    try:
        publisher.undeclare()  # type: ignore[no-untyped-call]  # the stub leaves out the result
    except zenoh.ZError as error:
        logger.debug("%s: not undeclared: %s", publisher.key_expr, error)
