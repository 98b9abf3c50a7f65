"""`aionode bag diff` and `shrink`."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

import pytest
from click.testing import CliRunner, Result

from aionode import bag
from aionode.cli._main import root
from aionode.clock import Time
from aionode.interfaces.std_msgs.msg import Float64

if TYPE_CHECKING:
    from pathlib import Path

S = 1_000_000_000

FAILS_AT_SEVEN = """
import json, os
piece = json.loads(os.environ["AIONODE_REPLAY_PIECE"])
assert not ("/a" in piece["topics"] and piece["start_ns"] <= 7 * 10**9 < piece["end_ns"])
"""
"""A program that fails like a test that needs one message; a real test takes a second."""


def aionode(*arguments: str | Path) -> Result:
    """Run `aionode bag` with arguments."""
    return CliRunner().invoke(root, ["bag", *map(str, arguments)])


def write(path: Path, last: float = 9.0) -> Path:
    """Write a bag of ten numbers on two topics, one each second."""
    with bag.BagWriter(path) as writer:
        for second in range(10):
            message = Float64(data=last if second == 9 else float(second))
            writer.write_message("/a", message, Time(nanoseconds=second * S))
            writer.write_message("/b", message, Time(nanoseconds=second * S))
    return path


def test_two_bags_are_compared(tmp_path: Path) -> None:
    """The status says whether they differ, the lines say where."""
    a, b = write(tmp_path / "a"), write(tmp_path / "b", last=9.5)

    assert (aionode("diff", a, a).exit_code, aionode("diff", a, a).output) == (
        0,
        "no differences\n",
    )
    differing = aionode("diff", a, b)
    assert differing.exit_code == 1
    assert "/a at 9.000000 s: data: 9.0 != 9.5\n" in differing.output
    assert aionode("diff", a, b, "--tolerance", "1").exit_code == 0
    assert '"field":"data","a":9.0,"b":9.5}' in aionode("diff", a, b, "--json").output


@pytest.mark.slow
def test_the_shortest_failing_piece_is_written(tmp_path: Path) -> None:
    """One message of twenty is left."""
    path = write(tmp_path / "run")
    command = (sys.executable, "-S", "-c", FAILS_AT_SEVEN)

    result = aionode("shrink", path, "-o", tmp_path / "out", "--", *command)

    assert result.exit_code == 0, result.output
    with bag.open(tmp_path / "out") as piece:
        assert [(record.topic, record.message.data) for record in piece.read()] == [("/a", 7.0)]


def test_an_existing_folder_is_refused_before_the_search(tmp_path: Path) -> None:
    """A search may take an hour."""
    result = aionode("shrink", write(tmp_path / "run"), "-o", tmp_path, "--", "true")

    assert result.exit_code == 2
    assert "already exists" in result.output


@pytest.fixture(autouse=True)
def _few_steps(monkeypatch: pytest.MonkeyPatch) -> None:
    """Cut no finer than a second: each step is a process."""
    monkeypatch.setattr("aionode.bag.replaying.shrinking.MIN_NS", S // 2)
