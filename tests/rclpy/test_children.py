"""Processes that a program starts with `multiprocessing` import what the program imports."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]

PROGRAM = """
import multiprocessing
import sys

from geometry_msgs.msg import Point
import rclpy
from own_msgs.msg import Words
from ours import TEXT


def child(answers, deeper):
    if deeper:
        process = multiprocessing.get_context(sys.argv[1]).Process(target=child, args=(answers, 0))
        process.start()
        process.join()
    answers.put((Point(x=1.0), Words(words=TEXT), rclpy.exceptions.InvalidHandle.__module__))


if __name__ == "__main__":
    context = multiprocessing.get_context(sys.argv[1])
    answers = context.Queue()
    process = context.Process(target=child, args=(answers, 1))
    process.start()
    for _ in range(2):
        print(answers.get(timeout=40))
    process.join()
"""
ANSWER = (
    "(geometry_msgs.msg.Point(x=1.0, y=0.0, z=0.0), own_msgs.msg.Words(words='hi'), "
    "'rclpy._rclpy_pybind11')\n"
)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A workspace with a program, a module beside it, and a message package."""
    for name in ("robot", "own_msgs"):
        (tmp_path / "src" / name).mkdir(parents=True)
        (tmp_path / "src" / name / "package.xml").write_text(
            f"<package format='3'><name>{name}</name></package>"
        )
    (tmp_path / "src/robot/program.py").write_text(PROGRAM)
    (tmp_path / "src/robot/ours.py").write_text("TEXT = 'hi'\n")
    (tmp_path / "src/own_msgs/msg").mkdir()
    (tmp_path / "src/own_msgs/msg/Words.msg").write_text("string words\n")
    return tmp_path


def output_of(method: str, *options: str, cwd: Path) -> str:
    """Return what the program prints, started in a folder, if it prints no error."""
    program = cwd / "program.py"
    done = subprocess.run(
        [sys.executable, "-m", "aionode.rclpy", *options, str(program), method],
        cwd=cwd.anchor,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
        capture_output=True,
        text=True,
        timeout=50,
        check=False,
    )
    assert done.stderr == ""
    return done.stdout


@pytest.mark.slow
@pytest.mark.parametrize("method", ["spawn", "forkserver"])
def test_a_process_imports_what_the_program_imports(folder: Path, method: str) -> None:
    """So does a process that this one starts: with fork, none of them could use a context."""
    assert output_of(method, cwd=folder / "src/robot") == ANSWER * 2


@pytest.mark.slow
def test_a_process_imports_the_messages_that_the_program_was_given(folder: Path) -> None:
    """The program is in no workspace, so they are in a folder of its command line."""
    shutil.move(folder / "src/robot/ours.py", folder)
    shutil.move(folder / "src/robot/program.py", folder)
    shutil.move(folder / "src/own_msgs", folder / "elsewhere/own_msgs")
    shutil.rmtree(folder / "src")

    assert output_of("spawn", "--interfaces", str(folder / "elsewhere"), cwd=folder) == ANSWER * 2
