"""The contract of transports; see `aionode.engine.transport.base`."""

from aionode.engine.transport.base import (
    NOT_INLINE_NS,
    Call,
    LinkStatus,
    Raw,
    Reader,
    ReaderRegistration,
    Registration,
    ReplyTo,
    Request,
    Requester,
    SampleInfo,
    Serve,
    StopSender,
    Transport,
    Writer,
)

__all__ = [
    "NOT_INLINE_NS",
    "Call",
    "LinkStatus",
    "Raw",
    "Reader",
    "ReaderRegistration",
    "Registration",
    "ReplyTo",
    "Request",
    "Requester",
    "SampleInfo",
    "Serve",
    "StopSender",
    "Transport",
    "Writer",
]
