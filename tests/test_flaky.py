"""The table of tests that fail, and pass when they are run again."""

from __future__ import annotations

from pathlib import Path

from tests.flaky import counted, read, write


def test_a_test_that_passed_when_it_was_run_again_is_counted() -> None:
    """The test that fails most often comes first, since it is mended first."""
    table = {"a": (1, "2026-01-01"), "b": (1, "2026-01-01")}
    table = counted(table, {"b", "c"}, "2026-01-02")

    assert list(table.items()) == [
        ("b", (2, "2026-01-02")),
        ("a", (1, "2026-01-01")),
        ("c", (1, "2026-01-02")),
    ]


def test_what_was_counted_is_read_again(tmp_path: Path) -> None:
    """Names of tests have commas and quotes: parameters are part of them."""
    table = {'tests/test_a.py::test_b[x, "y"]': (3, "2026-01-02")}
    write(tmp_path / "flaky.csv", table)

    assert read(tmp_path / "flaky.csv") == table
    assert read(tmp_path / "none.csv") == {}
