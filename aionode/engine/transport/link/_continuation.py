"""Continues a link over Zenoh: batches of frames, each authenticated.

Zenoh accepts a batch from anyone, and may show it to anyone. So each end of a link creates a secret
for it, and sends it to the other end over the socket. A batch carries a keyed hash instead of the
secret: whoever sees a batch can neither forge nor alter one. Batches are numbered to prevent
replays; only the stop of a lease may arrive more than once, and in any order.
"""

from __future__ import annotations

import struct
from hashlib import blake2b
from hmac import compare_digest
from typing import TYPE_CHECKING, Final

from aionode._process.recent import Recent
from aionode.engine.transport.link._protocol import FrameParser, Kind
from aionode.errors import FrameError

if TYPE_CHECKING:
    from aionode.engine.transport.link._protocol import Frame

__all__ = ["STOPS", "LinkSecrets", "seal"]

HEADER: Final = struct.Struct("<16s16sQ")  # the name of the link, the hash of the rest, the number

HASH_SIZE: Final = 16

STOPS: Final = 0
"""The number of batches that contain only stops of leases."""

MAX_LINKS: Final = 4_000
"""Number of links whose secrets are remembered; a batch follows soon after its link's end."""


def name_of(secret: bytes) -> bytes:
    """Return the public name of a link: a hash of its secret."""
    return blake2b(key=secret, digest_size=HASH_SIZE, person=b"name").digest()


def hash_of(secret: bytes, rest: bytes | memoryview) -> bytes:
    """Return the hash of a batch's number and frames, keyed with the secret of the link."""
    return blake2b(rest, key=secret, digest_size=HASH_SIZE, person=b"batch").digest()


def seal(secret: bytes, number: int, frames: bytes) -> bytes:
    """Return frames as an authenticated batch.

    Args:
        secret: The sender's secret of the link.
        number: 1 for the first batch of the link, 2 for the next one, or `STOPS`.
        frames: The frames.
    """
    rest = number.to_bytes(8, "little") + frames
    return name_of(secret) + hash_of(secret, rest) + rest


class LinkSecret:
    """The secret by which the other end of a link authenticates itself.

    Args:
        participant: Its context.
        secret: Its secret.

    Attributes:
        number: The number of its last batch.
    """

    def __init__(self, participant: str, secret: bytes) -> None:
        self.participant = participant
        self.secret = secret
        self.number = 0


class LinkSecrets:
    """The secrets of the other ends of all recent links."""

    def __init__(self) -> None:
        self._by_name: Recent[bytes, LinkSecret] = Recent(MAX_LINKS)

    def add(self, participant: str, secret: bytes) -> None:
        """Remember the secret of a context at the other end of a new link."""
        self._by_name.put(name_of(secret), LinkSecret(participant, secret))

    def clear(self) -> None:
        """Forget all of them."""
        self._by_name.clear()

    def unseal(self, batch: bytes) -> tuple[str, list[Frame]]:
        """Verify a batch; return the context that sent it, and its frames.

        Raises:
            FrameError: it is not from an end of a link, is a replay, or is malformed.
        """
        if len(batch) < HEADER.size:
            raise FrameError(f"expected a batch, got {len(batch)} bytes")
        name, proof, number = HEADER.unpack_from(batch)
        link = self._by_name.get(name)
        rest = memoryview(batch)[HEADER.size - 8 :]
        if link is None or not compare_digest(proof, hash_of(link.secret, rest)):
            raise FrameError("it is not authenticated by the other end of a link")
        if number != STOPS and number <= link.number:
            raise FrameError(f"batch {number} of a link was received twice")
        frames = FrameParser().feed(batch[HEADER.size :])
        if number != STOPS:
            link.number = number
        elif any(frame.kind != Kind.STOP for frame in frames):
            raise FrameError("expected only stops in an unnumbered batch")
        return link.participant, frames
