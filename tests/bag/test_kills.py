"""Kill a recorder at fifty random moments, and cut its power: make bag-kills.

At most the last second may be missing. SIGKILL leaves what was written; a power cut leaves only
what the last fdatasync confirmed, so the file is cut to its size then, or continued with zeros.
"""

from __future__ import annotations

import asyncio
import random
import shutil
import sys
import textwrap
from pathlib import Path

import pytest

from aionode import bag
from aionode.clock import Clock, ClockType

PROGRAM = textwrap.dedent("""
    import asyncio, os, sys
    from aionode import bag
    from aionode.clock import Time
    from aionode.interfaces.std_msgs.msg import String
    from aionode.testing import local_context

    sync = os.fdatasync

    def noted(fd):
        size = os.fstat(fd).st_size
        sync(fd)
        with open(sys.argv[1] + ".synced", "a") as file:
            file.write(f"{size}\\n")

    os.fdatasync = noted

    async def main():
        async with local_context() as context:
            async with bag.Recorder(sys.argv[1], topics=[], context=context) as recorder:
                print("recording", flush=True)
                while True:
                    for _ in range(20):
                        recorder.write("/x", String(data=os.urandom(50).hex()))
                    await asyncio.sleep(0.01)

    asyncio.run(main())
""")
"""It records two thousand messages a second, and notes how large the file is at each sync."""

TIMES = 50
AT_ONCE = 3
LAST_S = 1.0
"""The seconds of a recording that may be lost."""


async def killed(path: Path, after_s: float) -> int:
    """Run the program, kill it after a while, and return when that was, in nanoseconds."""
    process = await asyncio.create_subprocess_exec(
        sys.executable, "-c", PROGRAM, str(path), stdout=asyncio.subprocess.PIPE
    )
    try:
        assert process.stdout is not None
        assert await process.stdout.readline() == b"recording\n"
        await asyncio.sleep(after_s)  # noqa: TID251  # another process has a real clock
        killed_ns = Clock(clock_type=ClockType.SYSTEM_TIME).now().nanoseconds
    finally:
        process.kill()
        await process.wait()
    return killed_ns


def seconds_lost(path: Path, killed_ns: int) -> float:
    """Repair a bag, and return how long before the end its last message is."""
    bag.check(path)
    with bag.open(path) as run:
        times = [record.time_ns for record in run.read()]
        assert run.message_count == len(times)
    assert times == sorted(times)
    return (killed_ns - times[-1]) / 1e9 if times else float("inf")


def after_power_cut(path: Path, number: int) -> Path:
    """Return a copy of a bag as a power cut leaves it, shortened or with zeros at its end."""
    copy = path.with_name(f"{path.name}_cut") / path.name
    shutil.copytree(path, copy)
    synced = path.with_name(f"{path.name}.synced")
    size = int(synced.read_text().split()[-1]) if synced.exists() else 0
    file = copy / f"{path.name}_0.mcap"
    data = file.read_bytes()
    file.write_bytes(data[:size] + bytes(len(data) - size) * (number % 2))
    return copy


@pytest.mark.stress
@pytest.mark.processes
@pytest.mark.timeout(600)
def test_all_but_the_last_second_outlives_a_kill_and_a_power_cut(tmp_path: Path) -> None:
    """The last seconds before a crash are the ones that matter."""
    moments = random.Random(7)  # noqa: S311  # any moments
    places = asyncio.Semaphore(AT_ONCE)
    lost: list[float] = []

    async def once(number: int) -> None:
        path = tmp_path / f"run{number}"
        after_s = moments.uniform(0.02, 3.0)
        async with places:
            killed_ns = await killed(path, after_s)
        if after_s <= LAST_S:  # there may be nothing yet
            seconds_lost(path, killed_ns)
            return
        cut = after_power_cut(path, number)
        lost.append(seconds_lost(cut, killed_ns))
        lost.append(seconds_lost(path, killed_ns))

    async def all_of_them() -> None:
        async with asyncio.TaskGroup() as tasks:
            for number in range(TIMES):
                tasks.create_task(once(number))

    asyncio.run(all_of_them())
    assert len(lost) > TIMES
    assert max(lost) <= LAST_S
