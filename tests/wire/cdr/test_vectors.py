"""Encoding and decoding as ROS 2 itself does it."""

from __future__ import annotations

import pytest

from aionode.wire import cdr
from aionode.wire.cdr._fallback_decoder import decode_slowly
from tests.support.samples import Sample, all_samples

SAMPLES = {f"{sample.name}-{number}": sample for number, sample in enumerate(all_samples())}
WITH_GARBAGE = {name: sample for name, sample in SAMPLES.items() if sample.others}


def test_there_are_as_many_samples_as_there_were() -> None:
    """A file that lost its content would make all other tests pass."""
    assert len(SAMPLES) == 466 + 48


@pytest.mark.parametrize("sample", SAMPLES.values(), ids=SAMPLES)
def test_a_message_is_encoded_as_by_ros(sample: Sample) -> None:
    """Byte by byte, with zeros as padding and nothing at the end."""
    assert cdr.encode(sample.message) == sample.data


@pytest.mark.parametrize("sample", SAMPLES.values(), ids=SAMPLES)
def test_the_pieces_of_a_message_are_what_ros_writes(sample: Sample) -> None:
    """Put together, they are the same bytes."""
    assert b"".join(cdr.parts_encoder(type(sample.message))(sample.message)) == sample.data


@pytest.mark.parametrize("sample", SAMPLES.values(), ids=SAMPLES)
def test_a_message_of_ros_is_decoded(sample: Sample) -> None:
    """From bytes and from other memory, by generated and by plain code."""
    cls = type(sample.message)

    assert cdr.decode(cls, sample.data) == sample.message
    assert cdr.decode(cls, bytearray(sample.data)) == sample.message
    assert decode_slowly(cls, memoryview(sample.data)) == sample.message


@pytest.mark.parametrize("sample", WITH_GARBAGE.values(), ids=WITH_GARBAGE)
def test_garbage_in_padding_and_at_the_end_is_not_looked_at(sample: Sample) -> None:
    """Fast-CDR leaves the gaps as they were, and sends up to eight bytes too many."""
    cls = type(sample.message)

    for data in sample.others:
        assert cdr.decode(cls, data) == sample.message
        assert decode_slowly(cls, memoryview(data)) == sample.message
