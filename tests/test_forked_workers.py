"""`pytest -n`: every test has a report, whatever happens to the process that runs it."""

from __future__ import annotations

import os
import sys
from pathlib import Path

import pytest

from tests.support.fork_server import run

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="elsewhere, pytest-xdist is used")

CONFTEST = """
from tests.forked_workers import ForkedWorkers

def pytest_configure(config):
    config.pluginmanager.register(ForkedWorkers(2, splits_files=False))
"""

TESTS = """
import atexit, os

def test_that_passes():
    atexit.register(lambda: os.write(2, b"ended"))

def test_that_fails():
    print("what it printed")
    assert False, "as expected"

def test_that_ends_its_process():
    os._exit(3)

def test_after_that():
    pass
"""


def run_tests(folder: Path, *arguments: str) -> str:
    """Return the output of pytest for two files of `TESTS`, by two workers."""
    (folder / "conftest.py").write_text(CONFTEST)
    for name in ("test_one.py", "test_two.py"):
        (folder / name).write_text(TESTS)
    env = {**os.environ, "PYTHONPATH": str(Path(__file__).parent.parent)}
    command = ["-m", "pytest", "-q", "-p", "no:cacheprovider", *arguments]
    done = run(command, env=env, timeout=50, cwd=folder)
    return done.stdout + done.stderr


def test_the_end_of_a_worker_fails_the_test_that_it_ran(tmp_path: Path) -> None:
    """Another worker runs the other tests of the file."""
    output = run_tests(tmp_path)

    assert "test_one.py::test_that_ends_its_process was ended with status 3" in output
    assert "4 failed, 4 passed" in output


def test_a_failed_test_shows_what_it_printed(tmp_path: Path) -> None:
    """Workers do not capture into the same file."""
    output = run_tests(tmp_path, "-k", "fails")

    assert output.count("E       AssertionError: as expected") == 2
    assert output.count("Captured stdout call") == output.count("\nwhat it printed\n") == 2


def test_a_worker_ends_what_its_tests_started(tmp_path: Path) -> None:
    """Each calls the exit handlers that they have registered."""
    output = run_tests(tmp_path, "-k", "passes")

    assert output.count("ended") == 2


def test_the_first_failure_may_end_the_run(tmp_path: Path) -> None:
    """`-x` has the effect that it has without workers."""
    output = run_tests(tmp_path, "-x")

    assert "stopping after 1 failures" in output
