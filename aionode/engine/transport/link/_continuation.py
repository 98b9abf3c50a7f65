"""The continuation of a link over Zenoh: batches of frames, each with a proof of its sender.

Zenoh takes a batch from anyone, and may show it to anyone. So each end of a link makes a secret for
it, and tells it to the other end over the socket. A batch carries a keyed hash instead of the
secret: who has seen one can make no other one, and alter none. Batches are numbered, so that none
counts twice; only the stop of a lease may come more than once, and in any order.
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
"""The number of batches that hold nothing but stops of leases."""

MOST_LINKS: Final = 4_000
"""The secrets of so many links are remembered; a batch comes soon after the end of its link."""


def name_of(secret: bytes) -> bytes:
    """Return the public name of a link: a hash of its secret."""
    return blake2b(key=secret, digest_size=HASH_SIZE, person=b"name").digest()


def hash_of(secret: bytes, rest: bytes | memoryview) -> bytes:
    """Return what only the two ends of a link can make of the number and frames of a batch."""
    return blake2b(rest, key=secret, digest_size=HASH_SIZE, person=b"batch").digest()


def seal(secret: bytes, number: int, frames: bytes) -> bytes:
    """Return frames as a batch.

    Args:
        secret: The sender's secret of the link.
        number: 1 for the first batch of the link, 2 for the next one, or `STOPS`.
        frames: The frames.
    """
    rest = number.to_bytes(8, "little") + frames
    return name_of(secret) + hash_of(secret, rest) + rest


class LinkSecret:
    """The secret by which the other end of a link proves itself.

    Args:
        participant: Its context.
        secret: Its secret.

    Attributes:
        number: That of its last batch.
    """

    def __init__(self, participant: str, secret: bytes) -> None:
        self.participant = participant
        self.secret = secret
        self.number = 0


class LinkSecrets:
    """The secrets of the other ends of all links that there were lately."""

    def __init__(self) -> None:
        self._by_name: Recent[bytes, LinkSecret] = Recent(MOST_LINKS)

    def add(self, participant: str, secret: bytes) -> None:
        """Remember the secret of a context at the other end of a new link."""
        self._by_name.put(name_of(secret), LinkSecret(participant, secret))

    def clear(self) -> None:
        """Forget all of them."""
        self._by_name.clear()

    def unseal(self, batch: bytes) -> tuple[str, list[Frame]]:
        """Return the context that has sent a batch, and its frames.

        Raises:
            FrameError: it comes from no end of a link, or came before, or cannot be read.
        """
        if len(batch) < HEADER.size:
            raise FrameError(f"expected a batch, got {len(batch)} bytes")
        name, proof, number = HEADER.unpack_from(batch)
        link = self._by_name.get(name)
        rest = memoryview(batch)[HEADER.size - 8 :]
        if link is None or not compare_digest(proof, hash_of(link.secret, rest)):
            raise FrameError("nothing proves that it comes from the other end of a link")
        if number != STOPS and number <= link.number:
            raise FrameError(f"batch {number} of a link came a second time")
        frames = FrameParser().feed(batch[HEADER.size :])
        if number != STOPS:
            link.number = number
        elif any(frame.kind != Kind.STOP for frame in frames):
            raise FrameError("expected nothing but stops in a batch without a number")
        return link.participant, frames
