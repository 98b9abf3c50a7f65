"""The encoding of messages; see `aionode.engine.wire.cdr`."""

from aionode.engine.wire.cdr import (
    Data,
    MessageFamily,
    decode,
    decoder,
    encode,
    encoder,
    has_buffers,
    has_views,
    parts_encoder,
)

__all__ = [
    "Data",
    "MessageFamily",
    "decode",
    "decoder",
    "encode",
    "encoder",
    "has_buffers",
    "has_views",
    "parts_encoder",
]
