"""A robot as a systemd service and in a container, with the documentation's files."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent.parent
EXAMPLES = ROOT / "examples"


@pytest.fixture(scope="module")
def instructions() -> list[tuple[str, str]]:
    """Return the instructions of the Dockerfile with their arguments."""
    lines = (EXAMPLES / "Dockerfile").read_text(encoding="utf-8").splitlines()
    words = [line.partition(" ") for line in lines if not line.startswith("#")]
    return [(instruction, rest) for instruction, _, rest in words]


@pytest.mark.skipif(shutil.which("systemd-analyze") is None, reason="systemd is not installed")
def test_systemd_accepts_the_unit(tmp_path: Path) -> None:
    """A misspelled key is ignored by systemd, and noticed only when it is needed."""
    unit = (EXAMPLES / "robot.service").read_text(encoding="utf-8")
    text, count = re.subn(r"ExecStart=\S+", f"ExecStart={sys.executable}", unit)
    assert count == 1
    file = tmp_path / "robot.service"
    file.write_text(text)
    verify = ["systemd-analyze", "verify", "--man=no", str(file)]
    done = subprocess.run(verify, capture_output=True, text=True, check=False)
    # It also tells of other units of this machine.
    said = [line for line in done.stderr.splitlines() if "robot.service" in line]

    assert said == []


def test_the_unit_signals_the_system_alone_and_gives_it_the_time_to_stop() -> None:
    """Two members that hang take 12 s each; after the limit, systemd kills what is left."""
    unit = (EXAMPLES / "robot.service").read_text(encoding="utf-8")
    program = re.search(r"ExecStart=\S+/python /opt/robot/(\S+)", unit)

    assert "\nKillMode=mixed\n" in unit
    assert int(re.findall(r"TimeoutStopSec=(\d+)", unit)[0]) >= 24
    assert program is not None
    assert (EXAMPLES / program[1]).is_file()


def test_the_image_has_what_the_package_is_built_from(instructions: list[tuple[str, str]]) -> None:
    """A missing file, extra or Python version can be found without Docker."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    copied = [word for name, rest in instructions if name == "COPY" for word in rest.split()[:-1]]
    extras = re.findall(r"\[([\w,]+)\]'", dict(instructions)["RUN"])[0].split(",")
    python = re.fullmatch(r"python:(3\.\d+)-slim", dict(instructions)["FROM"])

    assert all((ROOT / source).exists() for source in copied)
    assert {"pyproject.toml", project["readme"], *project["license-files"], "aionode"} <= {*copied}
    assert {*extras} <= {*project["optional-dependencies"]}
    assert python is not None
    assert f"Programming Language :: Python :: {python[1]}" in project["classifiers"]


def test_the_container_runs_the_robot_and_stops_it(instructions: list[tuple[str, str]]) -> None:
    """The command is a list, so that signals reach the system rather than a shell."""
    places = [rest.split() for name, rest in instructions if name == "COPY"]
    folder = next(
        source for source, place in (copied[-2:] for copied in places) if place == "/robot"
    )
    command = json.loads(dict(instructions)["CMD"])

    assert dict(instructions)["WORKDIR"] == "/robot"
    assert (command[0], dict(instructions)["STOPSIGNAL"]) == ("python", "SIGINT")
    assert (ROOT / folder / command[1]).is_file()
