"""Messages of unitree_api.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated

from aionode.message import DEFAULT, Bytes, Ints, Message, Sequence, int8, int32, int64, uint8

__all__ = [
    "Request",
    "RequestHeader",
    "RequestIdentity",
    "RequestLease",
    "RequestPolicy",
    "Response",
    "ResponseHeader",
    "ResponseStatus",
]


class RequestIdentity(Message, typename="unitree_api/msg/RequestIdentity"):
    """RequestIdentity, as Unitree defines it."""

    id: int64 = 0
    api_id: int64 = 0


class RequestLease(Message, typename="unitree_api/msg/RequestLease"):
    """RequestLease, as Unitree defines it."""

    id: int64 = 0


class RequestPolicy(Message, typename="unitree_api/msg/RequestPolicy"):
    """RequestPolicy, as Unitree defines it."""

    priority: int32 = 0
    noreply: bool = False


class RequestHeader(Message, typename="unitree_api/msg/RequestHeader"):
    """RequestHeader, as Unitree defines it."""

    identity: RequestIdentity = DEFAULT
    lease: RequestLease = DEFAULT
    policy: RequestPolicy = DEFAULT


class Request(Message, typename="unitree_api/msg/Request"):
    """Request, as Unitree defines it."""

    header: RequestHeader = DEFAULT
    parameter: str = ""
    binary: Annotated[Bytes, Sequence[uint8]] = DEFAULT


class ResponseStatus(Message, typename="unitree_api/msg/ResponseStatus"):
    """ResponseStatus, as Unitree defines it."""

    code: int32 = 0


class ResponseHeader(Message, typename="unitree_api/msg/ResponseHeader"):
    """ResponseHeader, as Unitree defines it."""

    identity: RequestIdentity = DEFAULT
    status: ResponseStatus = DEFAULT


class Response(Message, typename="unitree_api/msg/Response"):
    """Response, as Unitree defines it."""

    header: ResponseHeader = DEFAULT
    data: str = ""
    binary: Annotated[Ints, Sequence[int8]] = DEFAULT
