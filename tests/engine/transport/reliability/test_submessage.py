"""The wire format of acknowledgements."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st
from msgspec.structs import astuple

from aionode.engine.transport.reliability.submessage import (
    LARGEST,
    MAX_RANGES,
    Submessage,
    SubmessageKind,
    pack,
    pack_ranges,
    unpack,
)

NUMBERS = st.integers(-LARGEST, LARGEST)
GIDS = st.binary(min_size=16, max_size=16)


@given(st.sampled_from(SubmessageKind), GIDS, GIDS, NUMBERS, NUMBERS, st.binary())
def test_what_was_packed_is_unpacked(
    kind: SubmessageKind, writer: bytes, reader: bytes, first: int, last: int, rest: bytes
) -> None:
    """Every kind, with all its fields."""
    data = pack(kind, writer, reader, first, last, rest)
    assert unpack(data) == Submessage(kind, writer, reader, first, last, rest)


@given(st.binary(max_size=120))
def test_anything_else_is_none(data: bytes) -> None:
    """Any program may publish anything under a key."""
    said = unpack(data)
    assert said is None or pack(*astuple(said))[4:] == data[4:]


@given(st.lists(st.tuples(NUMBERS, NUMBERS), max_size=2 * MAX_RANGES))
def test_an_acknack_names_so_many_ranges_at_most(ranges: list[tuple[int, int]]) -> None:
    """The rest is named in the next ACKNACK."""
    said = unpack(pack(SubmessageKind.ACKNACK, bytes(16), bytes(16), 1, 0, pack_ranges(ranges)))
    assert said is not None
    assert said.ranges() == ranges[:MAX_RANGES]


def test_ranges_that_were_cut_are_left_out() -> None:
    """Half a range is meaningless."""
    said = unpack(
        pack(SubmessageKind.ACKNACK, bytes(16), bytes(16), 1, 0, pack_ranges([(1, 2), (5, 6)])[:-1])
    )
    assert said is not None
    assert said.ranges() == [(1, 2)]


@pytest.mark.parametrize("kind", SubmessageKind)
@pytest.mark.parametrize("number", [LARGEST + 1, 2**63 - 1, -(2**63)])
def test_numbers_that_no_writer_reaches_are_malformed(kind: SubmessageKind, number: int) -> None:
    """A reader led to such a number could not pack its next ACKNACK, an error in the event loop."""
    assert unpack(pack(kind, bytes(16), bytes(16), number, 0)) is None
    assert unpack(pack(kind, bytes(16), bytes(16), 0, number)) is None
