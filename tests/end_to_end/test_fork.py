"""A forked child cannot use its parent's context, and does the parent no harm."""

from __future__ import annotations

import os
import signal
import subprocess
from contextlib import suppress
from pathlib import Path

import pytest

from tests.support.links import folder

__all__ = ["folder"]  # a fixture
from tests.support import fork_server

MEMBER = Path(__file__).with_name("fork_member.py")
ROOT = Path(__file__).parents[2]

pytestmark = pytest.mark.skipif(not hasattr(os, "fork"), reason="this system does not fork")


def told(how: str, *, fresh: bool = False) -> list[str]:
    """Return the program's output; it leaves no process behind."""
    with fork_server.start(
        [str(MEMBER), how],
        fresh=fresh,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        cwd=ROOT,
        env={**os.environ, "PYTHONPATH": str(ROOT)},
        process_group=0,
    ) as process:
        try:
            output, _ = process.communicate(timeout=30)
        finally:
            with suppress(ProcessLookupError):
                os.killpg(process.pid, signal.SIGKILL)
    assert process.returncode == 0, output
    return output.splitlines()


@pytest.mark.parametrize("how", ["a node", "its context", "a context"])
def test_a_forked_child_is_refused_a_node_and_told_of_spawn(how: str) -> None:
    """It would have the parent's sockets and shared memory, but no threads to serve them."""
    lines = told(how)
    (refusal,) = (line for line in lines if line.startswith("child:"))
    assert refusal.startswith("child: ForkedProcessError")
    assert 'get_context("spawn")' in refusal
    assert lines[-3:] == ["exit 0", "sockets 2", "parent: done"]


def test_a_forked_child_cannot_publish_with_what_it_has_inherited() -> None:
    """Nothing of it is sent, and its parent continues."""
    lines = told("publish")
    assert lines[0].startswith("child: EntityDestroyedError")
    assert lines[1:] == ["exit 0", "sockets 2", "parent: done"]


@pytest.mark.parametrize("how", ["nothing", "destroy", "local"])
def test_a_forked_child_that_uses_no_network_does_its_work(how: str) -> None:
    """Garbage collection, cleanup, and nodes of a context without network do no harm."""
    assert told(how) == ["child: done", "exit 0", "sockets 2", "parent: done"]


def test_a_pool_of_forked_processes_works_beside_a_node() -> None:
    """As with `run_in_executor` for long computations."""
    assert told("pool") == ["squares 0 1 4 9", "sockets 2", "parent: done"]


def test_a_subprocess_with_a_function_before_exec_works_beside_a_node() -> None:
    """Python forks for it as well."""
    assert [line for line in told("subprocess") if line != "1"] == [
        "exit 0",
        "sockets 2",
        "parent: done",
    ]


@pytest.mark.slow
def test_a_forked_child_may_end_as_programs_do() -> None:
    """With its exit handlers and the finalization of the interpreter."""
    assert told("between", fresh=True) == ["exit 0", "parent: done"]
