"""Tests of dicts that forget their oldest keys."""

from __future__ import annotations

from hypothesis import given
from hypothesis import strategies as st

from aionode._process.recent import Recent


@given(st.lists(st.integers(0, 9)), st.integers(1, 5))
def test_the_last_keys_that_were_new_are_kept(keys: list[int], most: int) -> None:
    """Invented names cannot fill the memory, and a known name displaces none."""
    recent: Recent[int, int] = Recent(most)
    kept: list[int] = []
    for number, key in enumerate(keys):
        forgotten = recent.put(key, number)
        if key not in kept:
            kept.append(key)
            assert (forgotten is not None) == (len(kept) > most)
            kept = kept[-most:]
        assert recent[key] == number

    assert list(recent) == kept
