"""Encoding and decoding as ROS 2 itself does it."""

from __future__ import annotations

from aionode.engine.wire import cdr
from aionode.engine.wire.cdr._fallback_decoder import decode_slowly
from tests.support.samples import all_samples


def test_there_are_as_many_samples_as_there_were() -> None:
    """A file that lost its content would make all other tests pass."""
    assert len(all_samples()) == 466 + 48


def test_a_message_is_encoded_as_by_ros() -> None:
    """Byte by byte, with zeros as padding and nothing at the end."""
    for sample in all_samples():
        assert cdr.encode(sample.message) == sample.data, sample.name


def test_the_pieces_of_a_message_are_what_ros_writes() -> None:
    """Joined, they are the same bytes."""
    for sample in all_samples():
        pieces = cdr.parts_encoder(type(sample.message))(sample.message)

        assert b"".join(pieces) == sample.data, sample.name


def test_a_message_of_ros_is_decoded() -> None:
    """From bytes and from other memory, by generated and by plain code."""
    for sample in all_samples():
        cls = type(sample.message)

        assert cdr.decode(cls, sample.data) == sample.message, sample.name
        assert cdr.decode(cls, bytearray(sample.data)) == sample.message, sample.name
        assert decode_slowly(cls, memoryview(sample.data)) == sample.message, sample.name


def test_bytes_in_padding_and_at_the_end_are_ignored() -> None:
    """Fast-CDR does not clear the padding, and sends up to eight bytes too many."""
    others = [(sample, data) for sample in all_samples() for data in sample.others]

    assert len(others) == 279
    for sample, data in others:
        cls = type(sample.message)

        assert cdr.decode(cls, data) == sample.message, sample.name
        assert decode_slowly(cls, memoryview(data)) == sample.message, sample.name
