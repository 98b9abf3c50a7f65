"""The robot of examples/replay publishes the same in each process, however busy the machine is."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from aionode import bag
from examples.replay.robot import record, run_robot

ROOT = Path(__file__).parents[2]
PYTHONS = os.environ.get("AIONODE_REPLAY_PYTHONS", sys.executable).split(os.pathsep)
"""The Pythons of the long test, `make replay`, separated as in PATH."""

PROGRAM = """
import asyncio, sys
from pathlib import Path
from examples.replay.robot import run_robot
if sys.argv[2] == "uvloop":
    import uvloop
    run = uvloop.run
else:
    run = asyncio.run
print(run(run_robot(Path(sys.argv[1]))).digest())
"""


def digest_in_process(path: Path, seed: int, loop: str, python: str = sys.executable) -> str:
    """Return the digest of a run in a process of its own."""
    return subprocess.run(  # the program above
        [python, "-c", PROGRAM, str(path), loop],
        env=os.environ | {"PYTHONHASHSEED": str(seed), "PYTHONPATH": str(ROOT)},
        stdout=subprocess.PIPE,
        check=True,
        text=True,
    ).stdout.strip()


async def test_a_changed_constant_is_found_and_named(tmp_path: Path) -> None:
    """A failing test says where to look: the topic, the time and the field."""
    path = record(tmp_path / "run", seconds=2)
    (await run_robot(path)).save(tmp_path / "golden")

    same = await run_robot(path)
    other = await run_robot(path, gain=0.5001)

    assert bag.compare(same, tmp_path / "golden") == []
    first = bag.compare(other, tmp_path / "golden")[0]
    assert (first.topic, first.field) == ("/cmd_vel", "linear.x")
    assert bag.compare(other, tmp_path / "golden", tolerance={"/cmd_vel": 0.01}) == []


@pytest.mark.slow
@pytest.mark.processes
def test_each_process_publishes_the_same(tmp_path: Path) -> None:
    """The hashes of strings and the addresses of objects differ between processes."""
    path = record(tmp_path / "run", seconds=3)

    runs = [(1, "asyncio"), (2, "uvloop")]
    digests = {digest_in_process(path, seed, loop) for seed, loop in runs}

    assert len(digests) == 1


@pytest.mark.stress
@pytest.mark.timeout(3000)
def test_a_hundred_processes_publish_the_same_on_a_busy_machine(tmp_path: Path) -> None:
    """On asyncio and uvloop, with each given Python, while other processes use the processor."""
    path = record(tmp_path / "run")
    spin = [sys.executable, "-c", "while True: pass"]
    busy = [subprocess.Popen(spin) for _ in range(os.cpu_count() or 1)]  # as above
    try:
        digests = {
            digest_in_process(path, seed, "uvloop" if seed % 2 else "asyncio", python)
            for seed in range(1, 100 // len(PYTHONS) + 1)
            for python in PYTHONS
        }
    finally:
        for process in busy:
            process.kill()
            process.wait()

    assert len(digests) == 1
