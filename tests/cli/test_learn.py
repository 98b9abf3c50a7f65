"""``aionode learn``."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from aionode.cli import main
from tests.support.demonstrations import Timing, contract, demonstration


def test_export_says_what_became_of_the_messages(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """In plain words, with the episodes of a folder in order."""
    for name in ("b", "a"):
        demonstration(
            tmp_path / "runs" / name, length_sec=0.5, recorded_with=contract(), outcome="success"
        )
    status = main(["learn", "export", "--lerobot", str(tmp_path / "out"), str(tmp_path / "runs")])
    text = capsys.readouterr().out
    assert status == 0
    assert text.index("runs/a: 13 of 15 rows") < text.index("runs/b: ")
    assert "age p50" in text
    assert text.endswith("out: 2 episodes, 26 rows at 30 fps\n")


def test_export_over_the_limits_ends_with_1(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A script notices what a person would read."""
    joints = Timing(100, gaps=[(0.5, 1.0)])
    bag = demonstration(tmp_path / "run", joints=joints, recorded_with=contract())
    arguments = ["learn", "export", "--json", str(bag), "--lerobot"]
    assert main([*arguments, str(tmp_path / "out")]) == 1
    found = json.loads(capsys.readouterr().out)
    assert "missing" in found["problems"][str(bag)][0]
    assert main([*arguments, str(tmp_path / "lax"), "--max-dropped", "0.5"]) == 0
