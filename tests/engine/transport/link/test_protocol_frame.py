"""Frames arrive as they were sent, and malformed data is detected."""

from __future__ import annotations

import itertools
from typing import Any

import msgspec
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from aionode.engine.transport.link import _protocol as protocol
from aionode.engine.transport.link._protocol import BufferRef, Frame, FrameParser, Kind
from aionode.errors import FrameError

NUMBERS = st.integers(-(2**63), 2**63 - 1)
GIDS = st.binary(min_size=16, max_size=16)
ONE = st.builds(
    Frame,
    st.sampled_from(Kind).map(int),
    NUMBERS,
    NUMBERS,
    GIDS,
    st.binary(max_size=200),
    st.booleans(),
)
FRAMES = st.lists(ONE, max_size=6)


def packed(one: Frame) -> bytes:
    """Return a frame as bytes."""
    return protocol.pack(
        one.kind, one.sequence, one.source_ns, one.gid, one.payload, in_shm=one.in_shm
    )


def pieces_of(stream: bytes, cuts: list[int]) -> list[bytes]:
    """Return the stream cut at these offsets."""
    places = [0, *sorted(cut % (len(stream) + 1) for cut in cuts), len(stream)]
    return [stream[a:b] for a, b in itertools.pairwise(places)]


@given(FRAMES, st.lists(st.integers(0, 10_000), max_size=12))
@settings(max_examples=settings().max_examples * 2)
def test_frames_come_out_as_they_went_in_however_the_stream_is_cut(
    frames: list[Frame], cuts: list[int]
) -> None:
    """A socket may return any number of bytes at a time."""
    parser = FrameParser()
    stream = b"".join(packed(one) for one in frames)
    found = [one for piece in pieces_of(stream, cuts) for one in parser.feed(piece)]
    assert found == frames
    assert parser.missing == protocol.HEADER_SIZE


@given(FRAMES, st.lists(st.integers(0, 10_000), max_size=12))
@settings(max_examples=50)
def test_messages_go_straight_to_their_handlers_in_the_order_of_all_frames(
    frames: list[Frame], cuts: list[int]
) -> None:
    """Messages take a fast path and everything else a slow one, but both share one stream."""
    parser = FrameParser()
    gid = bytes(16)
    frames = [
        msgspec.structs.replace(one, gid=gid) if one.kind == Kind.DATA else one for one in frames
    ]
    found: list[Frame] = []

    def take(payload: Any, sequence: int, source_ns: int, deadline_ns: int) -> None:
        found.append(Frame(Kind.DATA, sequence, source_ns, gid, payload))
        assert deadline_ns == 7

    def take_call(*call: Any) -> None:
        found.append(Frame(*call[:-1]))
        assert call[-1] == 7

    for piece in pieces_of(b"".join(packed(one) for one in frames), cuts):
        rest = parser.take_messages(piece, {gid: take}, take_call, 7)
        found += parser.feed(rest)
    assert found == frames
    assert parser.missing == protocol.HEADER_SIZE


def no_call(*_: object) -> None:
    """Take no requests or responses."""
    raise AssertionError


def test_messages_that_nothing_hears_are_left_out() -> None:
    """They were sent before the publisher's process learned that the subscription was destroyed."""
    data = packed(Frame(Kind.DATA, 1, 2, bytes(16), b"one"))
    parser = FrameParser()
    assert parser.take_messages(data + data[:-1], {}, no_call, 0) == data[:-1]


@given(ONE, st.data())
def test_what_is_cut_off_stays_missing(one: Frame, data: st.DataObject) -> None:
    """A frame cut off by the death of its sender counts as not sent."""
    whole = packed(one)
    cut = data.draw(st.integers(0, len(whole) - 1))
    parser = FrameParser()
    assert parser.feed(whole[:cut]) == []
    assert 0 < parser.missing <= len(whole) - cut
    assert parser.feed(whole[cut:]) == [one]


@given(st.binary(max_size=400), st.lists(st.integers(0, 400), max_size=4))
@settings(max_examples=settings().max_examples * 2)
def test_malformed_data_is_an_error_or_incomplete(stream: bytes, cuts: list[int]) -> None:
    """Nothing else may come of it, whatever the other end sends."""
    parser = FrameParser()
    try:
        for piece in pieces_of(stream, cuts):
            parser.feed(piece)
    except FrameError:
        pass


@pytest.mark.parametrize("offset", [4, 5, 6, 7], ids=["kind", "flags", "mark", "mark"])
def test_a_wrong_byte_in_the_header_is_noticed(offset: int) -> None:
    """Otherwise the receiver would misread everything after it."""
    header = bytearray(packed(Frame(Kind.DATA)))
    header[offset] ^= 0xF0
    with pytest.raises(FrameError):
        FrameParser().feed(bytes(header))


def test_a_wrong_length_is_noticed_before_memory_is_taken_for_it() -> None:
    """A length of gigabytes is garbage: that much data would never come."""
    header = bytearray(packed(Frame(Kind.DATA)))
    header[:4] = (protocol.MAX_INLINE + 1).to_bytes(4, "little")
    with pytest.raises(FrameError):
        FrameParser().feed(bytes(header))


def test_what_does_not_fit_is_not_packed() -> None:
    """Otherwise the other end would close the link."""
    with pytest.raises(FrameError):
        protocol.pack(Kind.DATA, 0, 0, bytes(16), bytes(protocol.MAX_INLINE + 1))


@given(st.builds(BufferRef, *[st.integers(0, 2**64 - 1)] * 3))
def test_a_buffer_reference_comes_out_as_it_went_in(ref: BufferRef) -> None:
    """Another buffer would mean another message."""
    assert BufferRef.unpack(ref.pack()) == ref


@given(st.binary(max_size=40).filter(lambda data: len(data) != 24))
def test_what_is_no_buffer_reference_is_refused(data: bytes) -> None:
    """A wrong reference must not select some buffer at random."""
    with pytest.raises(FrameError):
        BufferRef.unpack(data)
