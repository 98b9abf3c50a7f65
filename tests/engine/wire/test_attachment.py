"""The bytes beside each sample."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from aionode.engine.wire import _attachment as attachment

GOLDEN: dict[str, Any] = json.loads(
    Path(__file__).parents[2].joinpath("vectors", "vectors.json").read_text()
)["attachment"]
VALUES = (GOLDEN["seq"], GOLDEN["source_timestamp_ns"], bytes.fromhex(GOLDEN["gid"]))
PARSED = attachment.Attachment(*VALUES)
INT64 = st.integers(-(2**63), 2**63 - 1)


def test_the_bytes_are_those_of_rmw_zenoh() -> None:
    """A malformed attachment can abort a ROS process."""
    assert attachment.pack(*VALUES).hex() == GOLDEN["bytes"]


def test_the_form_of_the_first_jazzy_releases_is_read() -> None:
    """They write the name of each field; later releases do not."""
    legacy = bytes.fromhex(GOLDEN["legacy_jazzy_0.2.0_to_0.2.3"])

    assert attachment.unpack(legacy) == PARSED
    assert attachment.unpack(legacy.replace(b"source_gid", b"source_dig")) is None


@given(INT64, INT64, st.binary(min_size=16, max_size=16), st.binary(max_size=8))
def test_unpacking_undoes_packing(sequence: int, ns: int, gid: bytes, more: bytes) -> None:
    """Every value survives, and what a later release appends does no harm."""
    parsed = attachment.unpack(attachment.pack(sequence, ns, gid) + more)

    assert parsed == attachment.Attachment(sequence, ns, gid)


@given(st.binary(max_size=90))
def test_any_bytes_unpack_or_are_none(data: bytes) -> None:
    """Malformed data from the network must not raise."""
    unpacked = attachment.unpack(data)

    assert unpacked is None or len(unpacked.gid) == attachment.GID_SIZE


@given(st.integers(0, 32))
def test_a_truncated_one_is_none(size: int) -> None:
    """Half a gid identifies no endpoint."""
    assert attachment.unpack(bytes.fromhex(GOLDEN["bytes"])[:size]) is None


def test_a_gid_of_another_length_is_refused() -> None:
    """It would be written cut or filled, and match no endpoint."""
    with pytest.raises(ValueError, match="15 bytes, needs 16"):
        attachment.pack(1, 0, bytes(15))
