"""Damaged input for every parser: the documented error or a result, in bounded memory.

`make fuzz` does the same for longer, and guided by the code that is reached.
"""

from __future__ import annotations

import tracemalloc
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.fuzz.targets import TARGETS, Target

METADATA = TARGETS["metadata"].seeds()[0]

ALLOWED_BYTES = 4 << 20
"""Memory in bytes that parsing may always take, for imported modules and caches."""


def damaged(target: Target) -> st.SearchStrategy[bytes]:
    """Return a strategy for what is nearly right: pieces of good inputs, words, and any bytes."""
    seeds = st.sampled_from(target.seeds())
    piece = st.one_of(
        st.builds(
            lambda seed, a, b: seed[min(a, b) : max(a, b)], seeds, *[st.integers(0, 200)] * 2
        ),
        st.sampled_from([word.encode() for word in target.words] or [b"\0"]),
        st.sampled_from(
            [b"\xff\xff\xff\xff", b"\0\0\0\x80", b"9" * 30, b"\\", b"\r\n", "é²".encode()]
        ),
        st.binary(max_size=6),
    )
    whole = st.builds(
        lambda seed, at, new, skipped: seed[:at] + new + seed[at + skipped :],
        seeds,
        st.integers(0, 300),
        piece,
        st.integers(0, 8),
    )
    return st.one_of(whole, st.lists(piece, max_size=12).map(b"".join))


@pytest.mark.parametrize("target", TARGETS.values(), ids=lambda target: target.name)
def test_what_is_not_damaged_is_understood(target: Target) -> None:
    """Otherwise the seeds would be useless."""
    assert [target.run(seed) for seed in target.seeds()]


@pytest.mark.parametrize("target", TARGETS.values(), ids=lambda target: target.name)
@given(data=st.data())
@settings(deadline=5000)
def test_damaged_input_is_read_or_refused(target: Target, data: Any) -> None:
    """A result, or the one error that the parser documents; nothing else, and never a hang."""
    target.run(data.draw(damaged(target)))


@pytest.mark.parametrize("target", TARGETS.values(), ids=lambda target: target.name)
@given(data=st.data())
@settings(deadline=None, max_examples=settings().max_examples // 3)
def test_damaged_input_takes_no_more_memory_than_its_size_allows(target: Target, data: Any) -> None:
    """A length that it claims is believed only as far as the input reaches."""
    given_bytes = data.draw(damaged(target))
    tracemalloc.start()
    try:
        target.run(given_bytes)
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert peak < ALLOWED_BYTES + target.overhead * len(given_bytes)


@pytest.mark.parametrize(
    ("name", "data"),
    [
        ("idl", b'\0string x "\\U00110000"'),
        ("idl", b"\0string<=" + b"9" * 5000 + b" x"),
        ("idl", b"\0int32[" + b"9" * 5000 + b"] x"),
        ("idl", b"\0string[1000000000] x"),
        ("idl", b"\0byte[4000000000] x"),
        ("idl_files", b"\0module fuzz { const in32 A = 1; };"),
        ("idl_files", b"\0module fuzz { const long A = 1; typedef long B[3]; const B C = 1; };"),
        (
            "idl_files",
            b"\0module fuzz { module msg { struct Words { @default(value=1) X y; }; }; };",
        ),
        ("idl_files", b"\0\0"),
        ("metadata", METADATA.replace(b"run_0", b"r" * 300)),
        ("metadata", METADATA.replace(b"[run_0.mcap]", b'["run\\0_0.mcap"]')),
        ("metadata", b"output_bags: [{uri: a, all: true, regex: [x]}]"),
        ("errors", b"[" * 100_000),
        ("errors", b'{"type": "\\ud800", "text": "\\ud800"}'),
    ],
)
def test_inputs_that_were_found_stay_fixed(name: str, data: bytes) -> None:
    """Each raised another error once, or took gigabytes."""
    TARGETS[name].run(data)
