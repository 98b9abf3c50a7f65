"""A bag that is being recorded is not repaired, however silent its topics are."""

from __future__ import annotations

import fcntl
import os
import signal
import subprocess
import sys
import textwrap
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from mcap.records import Header

import rosbag2_py
from aionode import bag
from aionode.bag.files import lock
from aionode.bag.files.mcap_writer import MAGIC, record_bytes
from aionode.errors import BagError
from tests.bag.test_repair import numbers, record

PROGRAM = textwrap.dedent("""
    import asyncio, os, sys
    from aionode import bag
    from aionode.interfaces.std_msgs.msg import Int32
    from aionode.testing import local_context

    async def main():
        path, compression, forks = sys.argv[1:]
        async with local_context() as context:
            async with bag.Recorder(
                path, topics=[], context=context, compression=compression
            ) as recorder:
                for number in range(3):
                    recorder.write("/numbers", Int32(data=number))
                    await recorder.split()
                recorder.write("/numbers", Int32(data=3))
                size = os.path.getsize(f"{path}/run_3.mcap")
                while os.path.getsize(f"{path}/run_3.mcap") == size:
                    await asyncio.sleep(0.02)
                if forks:
                    told, tell = os.pipe()
                    if os.fork() == 0:
                        os.write(tell, b".")  # it has closed its copy of the lock
                        os.read(0, 1)  # until the test has ended
                        os._exit(0)
                    os.read(told, 1)
                print("silent", flush=True)
                await asyncio.sleep(60)

    asyncio.run(main())
""")
"""It records four messages in four files, and then nothing."""

REPAIRS: list[Callable[[Path], object]] = [
    bag.check,
    lambda path: bag.check(path / "run_3.mcap"),
    bag.reindex,
    lambda path: rosbag2_py.Reindexer().reindex(rosbag2_py.StorageOptions(str(path), "mcap")),
]


@contextmanager
def recorder(
    path: Path, compression: str = "zstd", forks: str = ""
) -> Iterator[subprocess.Popen[bytes]]:
    """Run a recorder whose topics stay silent."""
    with subprocess.Popen(
        [sys.executable, "-W", "ignore", "-c", PROGRAM, str(path), compression, forks],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
    ) as program:
        try:
            assert program.stdout is not None
            assert program.stdout.readline() == b"silent\n"
            for file in path.iterdir():
                os.utime(file, (1, 1))
            yield program
        finally:
            program.kill()


def content(path: Path) -> dict[str, bytes]:
    """Return the contents of a bag's files."""
    return {file.name: file.read_bytes() for file in path.iterdir()}


@pytest.mark.processes
@pytest.mark.parametrize(
    "compression",
    [
        "zstd",
        *(pytest.param(each, marks=pytest.mark.slow) for each in ("zstd_small", "lz4", "none")),
    ],
)
def test_a_silent_recording_is_left_alone_until_its_recorder_is_killed(
    compression: str, tmp_path: Path
) -> None:
    """A repair would cut off what is recorded next, and a suspended recorder may resume."""
    run = tmp_path / "run"
    with recorder(run, compression) as program:
        before = content(run)
        for is_stopped in (False, True):
            if is_stopped:
                program.send_signal(signal.SIGSTOP)
            for repair in REPAIRS:
                with pytest.raises(
                    (BagError, RuntimeError), match=rf"({program.pid}|another process) is recording"
                ):
                    repair(run)
            assert content(run) == before
        program.kill()
        program.wait()
        assert [found.repaired for found in bag.check(run)] == [False, False, False, True]
    assert numbers(run) == [0, 1, 2, 3]


@pytest.mark.processes
def test_a_forked_child_does_not_hold_the_lock_of_a_recorder_that_was_killed(
    tmp_path: Path,
) -> None:
    """Otherwise its bag could not be repaired while the child runs."""
    run = tmp_path / "run"
    with recorder(run, forks="yes") as program:
        program.kill()
        program.wait()
        bag.check(run)
    assert numbers(run) == [0, 1, 2, 3]


def test_a_closed_file_of_a_recording_can_be_checked(tmp_path: Path) -> None:
    """Checking only reads it."""
    with bag.BagWriter(tmp_path / "run") as out:
        out.split(1)
        assert bag.check(tmp_path / "run/run_0.mcap") == [("run_0.mcap", False, 0, 0)]
        with pytest.raises(BagError, match="nothing was changed"):
            bag.check(tmp_path / "run")


def without_locks(_: int, __: int) -> None:
    """Fail like `flock` on a file system without locks."""
    raise OSError


def test_without_locks_a_file_that_was_just_written_to_is_left_alone(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It may still be recorded; one that was not written to for a while is repaired."""
    record(tmp_path / "run")
    file = tmp_path / "run/run_0.mcap"
    file.write_bytes(file.read_bytes()[:-30])
    monkeypatch.setattr(fcntl, "flock", without_locks)
    with pytest.raises(BagError, match="end its recording first, or wait 5 s"):
        bag.check(tmp_path / "run")
    os.utime(file, (1, 1))
    assert bag.check(tmp_path / "run")[0].repaired


def test_a_file_that_another_program_was_just_writing_to_is_left_alone(tmp_path: Path) -> None:
    """rosbag2 takes no lock, so only the file's age shows that it may still be recorded."""
    file = tmp_path / "run_0.mcap"
    file.write_bytes(MAGIC + record_bytes(Header("ros2", "libmcap 1.1.0")))
    with pytest.raises(BagError, match="just written to"):
        bag.check(file)
    os.utime(file, (1, 1))
    assert bag.check(file)[0].repaired


def test_a_file_of_another_program_that_has_its_end_is_repaired_at_once(tmp_path: Path) -> None:
    """Its recorder has finished it, so its age does not matter."""
    file = tmp_path / "run_0.mcap"
    file.write_bytes(MAGIC + record_bytes(Header("ros2", "libmcap 1.1.0")) + MAGIC)
    assert bag.check(file)[0].repaired


def test_a_process_is_named_only_if_it_is_certain(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Files on different disks can have the same inode number."""
    listed = tmp_path / "locks"
    monkeypatch.setattr(lock, "LOCKS", listed)
    one = f"1: FLOCK  ADVISORY  WRITE 12 08:01:{tmp_path.stat().st_ino} 0 EOF\n"
    assert lock.holder_of(tmp_path) == "another process"
    listed.write_text(one)
    assert lock.holder_of(tmp_path) == "process 12"
    listed.write_text(one + one.replace("WRITE 12", "WRITE 13"))
    assert lock.holder_of(tmp_path) == "another process"
