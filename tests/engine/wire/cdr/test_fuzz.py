"""A short run of the fuzzer; `make fuzz` has the long one."""

from __future__ import annotations

import pytest

from tests.support.fuzz_cdr import fuzz


@pytest.mark.parametrize(
    "seed", [0, *(pytest.param(seed, marks=pytest.mark.slow) for seed in (1, 2, 3))]
)
def test_damaged_messages_of_ros_are_read_or_refused(seed: int) -> None:
    """A message or a DecodeError, and the same from both decoders."""
    cases = 500

    assert 0 < fuzz(cases, seed) < cases
