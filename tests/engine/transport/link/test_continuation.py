"""Batches that continue a link over Zenoh, and which senders are trusted."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from aionode.engine.transport.link import _continuation as continuation
from aionode.engine.transport.link._continuation import STOPS, LinkSecrets, seal
from aionode.engine.transport.link._protocol import Kind, RetransmitDone, pack
from aionode.errors import FrameError

SECRET = bytes(range(16))
GID = b"g" * 16
DATA = pack(Kind.DATA, 7, 0, GID, b"payload")
STOP = pack(Kind.STOP, 8, 0, GID, b"stop")


@pytest.fixture
def links() -> LinkSecrets:
    """Return the other end of a link to the context ``a1``."""
    links = LinkSecrets()
    links.add("a1", SECRET)
    return links


def test_the_other_end_of_a_link_is_believed(links: LinkSecrets) -> None:
    """It is still trusted after a newer link has replaced it."""
    links.add("a1", b"n" * 16)

    sender, frames = links.unseal(seal(SECRET, 1, DATA + RetransmitDone().pack()))

    assert sender == "a1"
    assert [frame.kind for frame in frames] == [Kind.DATA, Kind.RETRANSMIT_DONE]
    assert frames[0].payload == b"payload"


@pytest.mark.parametrize("secret", [bytes(16), b"x" * 16], ids=["zeros", "another"])
def test_nobody_else_is_believed(links: LinkSecrets, secret: bytes) -> None:
    """Another user of the machine can publish anything under the key."""
    with pytest.raises(FrameError, match="not authenticated"):
        links.unseal(seal(secret, 1, DATA))


@given(at=st.integers(0, 90), bit=st.integers(0, 7))
def test_a_batch_that_was_altered_is_not_believed(at: int, bit: int) -> None:
    """Otherwise anyone who had seen a batch could send other messages in it."""
    links = LinkSecrets()
    links.add("a1", SECRET)
    batch = bytearray(seal(SECRET, 1, DATA))
    batch[at % len(batch)] ^= 1 << bit

    with pytest.raises(FrameError):
        links.unseal(bytes(batch))


def test_a_batch_does_not_show_the_secret() -> None:
    """Any member of the domain may listen."""
    assert SECRET not in seal(SECRET, 1, DATA)


def test_a_batch_counts_once(links: LinkSecrets) -> None:
    """A replayed batch could end the wait for a newer one."""
    first, second = seal(SECRET, 1, DATA), seal(SECRET, 2, DATA)
    links.unseal(first)
    links.unseal(second)

    for batch in (first, second):
        with pytest.raises(FrameError, match="received twice"):
            links.unseal(batch)


def test_a_stop_may_come_more_than_once_and_before_a_batch(links: LinkSecrets) -> None:
    """It is sent past the event loop, with another priority, and repeated for safety."""
    for batch in (seal(SECRET, STOPS, STOP), seal(SECRET, 1, DATA), seal(SECRET, STOPS, STOP)):
        assert links.unseal(batch)[0] == "a1"


def test_only_stops_may_come_more_than_once(links: LinkSecrets) -> None:
    """A batch without a number could be repeated."""
    with pytest.raises(FrameError, match="expected only stops"):
        links.unseal(seal(SECRET, STOPS, DATA))


@given(st.binary(max_size=200))
def test_any_bytes_are_refused(data: bytes) -> None:
    """They raise the error that links count."""
    links = LinkSecrets()
    links.add("a1", SECRET)

    with pytest.raises(FrameError):
        links.unseal(data)


def test_secrets_are_bounded(monkeypatch: pytest.MonkeyPatch) -> None:
    """The oldest one is discarded, because links may come and go for months."""
    monkeypatch.setattr(continuation, "MAX_LINKS", 3)
    links = LinkSecrets()
    for number in range(10):
        links.add("b2", bytes([number]) * 16)

    for number in range(7):
        with pytest.raises(FrameError):
            links.unseal(seal(bytes([number]) * 16, 1, DATA))
    assert links.unseal(seal(b"\x09" * 16, 1, DATA))[0] == "b2"
