"""The same scenes on rclpy and on aionode, with the same visible results.

The files whose names end in ``scenarios.py`` have the scenes. ``expected.json`` is what rclpy 9.1.2
(ROS 2 Kilted) shows. With the path of an interpreter that has rclpy in ``RCLPY_PYTHON`` it is asked
again::

    python -m venv kilted
    kilted/bin/pip install 'ros-rclpy[fastrtps]' ros-std-msgs ros-test-msgs
    RCLPY_PYTHON=kilted/bin/python python -m pytest tests/rclpy/test_differential.py
"""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import pytest

from tests.support.peers import isolated_environment

HERE = Path(__file__).parent
PROGRAM = HERE / "more_scenarios.py"  # which imports the other ones
EXPECTED = HERE / "expected.json"
INTERPRETER = "RCLPY_PYTHON"
NAMES = [
    name
    for file in sorted(HERE.glob("*scenarios.py"))
    for name in re.findall(r"^@scene\ndef (\w+)", file.read_text(encoding="utf-8"), re.MULTILINE)
]
PROCESSES = 4
"""Number of processes that play at the same time, since most scenes mostly wait."""


def play(*command: str, environments: list[dict[str, str]]) -> dict[str, Any]:
    """Return the traces of all scenes, with one process per environment."""
    with ThreadPoolExecutor() as pool:
        parts = pool.map(
            lambda number: play_some(
                *command, *NAMES[number :: len(environments)], environment=environments[number]
            ),
            range(len(environments)),
        )
        return {name: trace for part in parts for name, trace in part.items()}


def play_some(*command: str, environment: dict[str, str]) -> dict[str, Any]:
    """Return the traces of some scenes, played in one process."""
    process = subprocess.run(
        command,
        capture_output=True,
        text=True,
        timeout=110,
        env={**os.environ, **environment},
        check=False,
    )
    assert process.stdout, process.stderr
    traces: dict[str, Any] = json.loads(process.stdout.splitlines()[-1])
    return traces


@pytest.fixture(scope="module")
def played() -> dict[str, Any]:
    """Return aionode's traces."""
    environments = [isolated_environment() for _ in range(PROCESSES)]
    return play(sys.executable, "-m", "aionode.rclpy", str(PROGRAM), environments=environments)


@pytest.mark.timeout(120)
@pytest.mark.parametrize("name", NAMES)
def test_a_scene_shows_what_it_shows_on_rclpy(name: str, played: dict[str, Any]) -> None:
    """The same callbacks in the same order and threads, results and exceptions."""
    assert played[name] == json.loads(EXPECTED.read_text(encoding="utf-8"))[name]


@pytest.mark.timeout(120)
@pytest.mark.skipif(
    INTERPRETER not in os.environ,
    reason=f"{INTERPRETER} is not set: no interpreter that has rclpy to compare with",
)
def test_rclpy_shows_what_is_expected() -> None:
    """The comparison is with what rclpy does, not with what was once written down."""
    environments = [
        {"ROS_DOMAIN_ID": str(domain_id), "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST"}
        for domain_id in range(87, 87 + PROCESSES)
    ]
    shown = play(os.environ[INTERPRETER], str(PROGRAM), environments=environments)

    assert shown == json.loads(EXPECTED.read_text(encoding="utf-8"))
