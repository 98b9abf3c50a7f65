"""``aionode learn``."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from aionode import bag
from aionode.cli import main
from tests.support.demonstrations import Timing, contract, demonstration
from tests.support.peers import isolated_environment

pexpect = pytest.importorskip("pexpect", reason="pseudo-terminals are of Unix")


@pytest.mark.slow
@pytest.mark.processes
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


@pytest.mark.slow
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


@pytest.mark.parametrize("given", ["nothere", "/proc"])
def test_a_file_that_is_missing_or_not_writable_is_one_line(
    given: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A typing error is no reason for a traceback."""
    run = demonstration(tmp_path / "run", length_sec=0.5, recorded_with=contract())
    arguments = ["/proc/out", str(run)] if given == "/proc" else [str(tmp_path / "out"), given]
    assert main(["learn", "export", "--lerobot", *arguments]) == 1
    assert capsys.readouterr().err.count("\n") == 1


LIMIT = "ulimit -f 600"
"""Files of the recorder have at most 300 kB, in blocks of POSIX."""


class Recording:
    """`aionode learn record` in a terminal, without a robot."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder / "runs"
        contract_file = folder / "contract.yaml"
        contract_file.write_text(json.dumps(contract().to_dict()))
        self.env = {**os.environ, **isolated_environment(), "AIONODE_LINK": "on", "TERM": "xterm"}
        arguments = ["--contract", str(contract_file), "-o", str(self.folder), "--topic", "/noise"]
        self.command: Any = pexpect.spawn(
            "sh",
            ["-c", f'{LIMIT}; exec "$0" -m aionode learn record "$@"', sys.executable, *arguments],
            env=self.env,
            encoding="utf-8",
            timeout=40.0,
            dimensions=(50, 200),
        )
        self.command.expect("Not recording")

    def press(self, key: str, shown: str) -> None:
        """Press a key, and wait for what it shows."""
        self.command.send(key)
        self.command.expect(shown)

    def outcomes(self) -> dict[str, str]:
        """Return how the episodes ended, by name."""
        found = {}
        for path in sorted(self.folder.iterdir()):
            with bag.open(path) as opened:
                found[path.name] = opened.custom_data.get("outcome", "")
        return found

    def end(self) -> None:
        """Press Ctrl-C, which is the normal end."""
        self.command.sendintr()
        self.command.expect(pexpect.EOF)
        self.command.close()
        assert "Traceback" not in self.command.before
        assert self.command.exitstatus == 0


@pytest.fixture
def in_terminal(tmp_path: Path) -> Iterator[Recording]:
    """A recorder in a terminal, which ends with the test."""
    opened = Recording(tmp_path)
    yield opened
    opened.command.close(force=True)


@pytest.mark.slow
@pytest.mark.processes
def test_keys_begin_and_end_episodes(in_terminal: Recording) -> None:
    """One hand is at the robot."""
    recording = r"Recording \S+episode_{}: turn the joint"
    in_terminal.press(" ", recording.format("0000"))
    in_terminal.press(" ", r"Ended \S+episode_0000: success")
    in_terminal.press(" ", recording.format("0001"))
    in_terminal.press("f", r"Ended \S+episode_0001: failure")
    in_terminal.press(" ", recording.format("0002"))
    in_terminal.press("d", r"Ended \S+episode_0002: discarded")
    in_terminal.press(" ", recording.format("0002"))
    in_terminal.press("r", r"Ended \S+episode_0002: discarded")
    in_terminal.command.expect(recording.format("0002"))
    in_terminal.press(" ", r"Ended \S+episode_0002: success")
    in_terminal.press("d", "no episode is being recorded; start one")
    in_terminal.end()
    assert in_terminal.outcomes() == {
        "episode_0000": "success",
        "episode_0001": "failure",
        "episode_0002": "success",
    }


@pytest.mark.slow
@pytest.mark.processes
def test_ctrl_c_closes_the_bag_of_an_episode_that_has_not_ended(in_terminal: Recording) -> None:
    """Nobody said how it ended, so it says nothing, either."""
    in_terminal.press(" ", "Recording ")
    in_terminal.end()
    assert in_terminal.outcomes() == {"episode_0000": ""}
    file = in_terminal.folder / "episode_0000/episode_0000_0.mcap"
    assert bag.check(file.parent) == [(file.name, False, 0, 0)]


@pytest.mark.slow
@pytest.mark.processes
def test_a_full_disk_ends_the_command_while_an_episode_is_recorded(in_terminal: Recording) -> None:
    """At once, in one line, and not when hours of demonstrations are ended."""
    noise = os.urandom(50_000).hex()
    publish = ["topic", "pub", "/noise", "std_msgs/msg/String", f"data: x{noise}", "-r", "20"]
    with subprocess.Popen(
        [sys.executable, "-m", "aionode", *publish],
        env=in_terminal.env,
        stdout=subprocess.DEVNULL,
    ) as robot:
        try:
            in_terminal.press(" ", "Recording ")
            in_terminal.command.expect("File too large; free some space")
            in_terminal.command.expect(pexpect.EOF)
        finally:
            robot.kill()
    in_terminal.command.close()
    assert "Traceback" not in in_terminal.command.before
    assert in_terminal.command.exitstatus == 1
    assert in_terminal.outcomes() == {"episode_0000": ""}
