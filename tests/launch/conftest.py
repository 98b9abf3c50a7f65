"""Fixtures of the tests of launch files."""

from __future__ import annotations

import textwrap
from pathlib import Path
from typing import Any

import pytest

from aionode.launch import Plan


class Files:
    """Launch files in a folder."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def write(self, name: str, text: str) -> str:
        """Write a file, and return its path."""
        file = self.folder / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(textwrap.dedent(text), encoding="utf-8")
        return str(file)

    def plan(self, name: str, text: str, **arguments: str) -> list[dict[str, Any]]:
        """Return the plan of a file with this text."""
        return list(Plan(self.write(name, text), arguments).records())

    def python(self, entities: str, *, imports: str = "", **arguments: str) -> list[dict[str, Any]]:
        """Return the plan of a Python file with these entities."""
        text = HEAD + textwrap.dedent(imports) + BODY.format(entities=textwrap.dedent(entities))
        return list(Plan(self.write("a.launch.py", text), arguments).records())


HEAD = """
from launch import LaunchDescription
from launch.actions import *
from launch.conditions import *
from launch.event_handlers import *
from launch.events import Shutdown as ShutdownEvent
from launch.events.process import *
from launch.launch_description_sources import *
from launch.substitutions import *
from launch_ros.actions import *
from launch_ros.descriptions import *
from launch_ros.substitutions import *
"""

BODY = """

def generate_launch_description():
    return LaunchDescription([
{entities}
    ])
"""


@pytest.fixture
def files(tmp_path: Path) -> Files:
    """Return a folder for launch files."""
    return Files(tmp_path)


@pytest.fixture
def package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return the prefix of an installed package ``robot`` with an executable ``driver``."""
    prefix = tmp_path / "install"
    marker = prefix / "share" / "ament_index" / "resource_index" / "packages" / "robot"
    program = prefix / "lib" / "robot" / "driver"
    for file in (marker, program):
        file.parent.mkdir(parents=True)
        file.write_text("#!/bin/sh\nexec sleep 100\n", encoding="utf-8")
    program.chmod(0o755)
    (prefix / "share" / "robot" / "launch").mkdir(parents=True)
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(prefix))
    return prefix
