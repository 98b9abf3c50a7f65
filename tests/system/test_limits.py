"""Limits of memory and processors, by cgroups of the kernel where that is allowed."""

from __future__ import annotations

import io
import os
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

import pytest

from aionode import Context
from aionode.system import System, SystemLog
from aionode.system._limits import Limits, own_cgroup
from tests.support.waiting import until

FOREVER = ["sleep", "1000"]
LIMITS = {"memory": ("memory.max", "100003840"), "hugetlb": ("hugetlb.2MB.max", "4194304")}
"""A limit of each of some controllers, as the kernel writes it. Any of them will do."""


@pytest.fixture
def output() -> io.StringIO:
    """What the system under test prints."""
    return io.StringIO()


@pytest.fixture
def system(output: io.StringIO) -> System:
    """A system whose nodes have no network."""
    return System("tested", context=Context(transport="local"), log=SystemLog(output))


@pytest.fixture
def limit(monkeypatch: pytest.MonkeyPatch) -> Iterator[tuple[str, str]]:
    """A limit that the kernel really sets here, for every process."""
    parent = own_cgroup()
    if parent is None or not os.access(parent, os.W_OK):
        pytest.skip("no cgroup v2 in which this user may create others")
    known = (parent / "cgroup.controllers").read_text().split()
    enabled = parent / "cgroup.subtree_control"
    before = enabled.read_text().split()
    controller = next(
        (controller_name for controller_name in LIMITS if controller_name in known), None
    )
    if controller is None or not os.access(enabled, os.W_OK):
        pytest.skip(f"no controller of {', '.join(LIMITS)} in cgroup v2 here")
    monkeypatch.setattr(Limits, "settings", lambda _: dict([LIMITS[controller]]))
    yield LIMITS[controller]
    if controller not in before:
        with suppress(OSError):  # somebody else uses it meanwhile
            enabled.write_text(f"-{controller}")


async def test_a_process_and_all_that_it_starts_are_in_a_cgroup_with_its_limits(
    system: System, limit: tuple[str, str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Even what hides from the guardian ends with its program: the kernel knows.

    The guardian removes the cgroup, as the supervisor may have been killed.
    """
    monkeypatch.setattr(Limits, "leave", lambda *_: None)
    hidden = tmp_path / "hidden"
    script = (
        f'(env -i setsid sh -c \'trap "" INT TERM; echo $$ >{hidden}; '
        "while :; do sleep 1; done' &); exec sleep 1000"
    )
    async with system:
        system.process(
            "greedy", ["sh", "-c", script], term_after_sec=0.1, kill_after_sec=0.1, cpu_cores=0.5
        )
        await until(lambda: hidden.exists() and hidden.read_text())
        pid = int(hidden.read_text())
        lines = Path(f"/proc/{pid}/cgroup").read_text().splitlines()
        name = next(line for line in lines if line.startswith("0::")).rpartition("/")[2]
        folder = (own_cgroup() or Path()) / name
        assert name == f"aionode-{os.getpid()}-greedy"
        assert (folder / limit[0]).read_text().strip() == limit[1]

        await system.stop("greedy")
        assert not Path(f"/proc/{pid}").exists()
        assert not folder.exists()


async def test_limits_that_are_not_allowed_are_named_and_left_out(
    system: System, output: io.StringIO, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The program runs all the same."""
    monkeypatch.setattr("aionode.system._limits.own_cgroup", lambda: None)
    async with system:
        system.process("greedy", FOREVER, memory_bytes=1_000_000_000, cpu_cores=0.5)
        await system.ready()

    assert "greedy: runs without its limits (memory.max, cpu.max)" in output.getvalue()


def test_limits_are_written_into_a_cgroup_of_its_own(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Beside that of the supervisor, which may have no cgroups with limits below it."""
    monkeypatch.setattr("aionode.system._limits.own_cgroup", lambda: tmp_path)
    (tmp_path / "cgroup.controllers").write_text("cpuset cpu io memory\n")
    (tmp_path / "cgroup.subtree_control").write_text("cpu\n")
    folder = Limits(1_000_000, 0.5).enter("greedy", SystemLog(io.StringIO()))

    assert folder is not None
    assert (tmp_path / "cgroup.subtree_control").read_text() == "+memory"
    assert (Path(folder) / "memory.max").read_text() == "1000000"
    assert (Path(folder) / "cpu.max").read_text() == "50000 100000"


def test_the_cgroup_is_found_that_may_have_others_below_it(tmp_path: Path) -> None:
    """A service with DelegateSubgroup has its own processes one level lower."""
    (tmp_path / "cgroup.controllers").write_text("cpu memory")
    membership = tmp_path / "membership"
    membership.write_text("1:name=systemd:/x\n0::/robot.service/supervisor\n")

    assert own_cgroup(membership, tmp_path) == tmp_path / "robot.service"
    assert own_cgroup(membership, tmp_path / "none") is None
    membership.write_text("0::/\n")
    assert own_cgroup(membership, tmp_path) == tmp_path
