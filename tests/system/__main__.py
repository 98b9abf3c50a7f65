"""Systems under load: ``python -m tests.system``, or ``make system-stress``.

Fifty processes, some of which misbehave, while others are killed at random; many starts and stops;
a robot that moves while its system ends. It prints figures, and exits with 1 if anything is wrong.
"""

from __future__ import annotations

import argparse
import asyncio
import os
import random
import re
import resource
import signal
import subprocess
import sys
import tempfile
import threading
from pathlib import Path
from uuid import uuid4

from aionode import Context
from aionode.clock import SteadyClock, perf_ns
from aionode.system import System, SystemLog
from tests.bytecode import share_bytecode
from tests.support.peers import isolated_environment
from tests.system.left import MARK, guardian, left

MEMBERS = 50

TICKER = """
import os, signal, sys, time
def end(*_):
    with open(sys.argv[2], "a") as file:
        file.write(sys.argv[1] + " ")
    os._exit(0)
signal.signal(signal.SIGINT, end)
number = 0
while True:
    print("tick", number, flush=True)
    number += 1
    time.sleep(0.1)
"""

CHATTY = """
import os, signal, sys, time
signal.signal(signal.SIGINT, lambda *_: sys.exit(0))
number, begin, rate = 0, time.monotonic(), 100_000
while True:
    while number >= (time.monotonic() - begin) * rate:
        time.sleep(0.005)
    text = b"".join(b"%098d\\n" % one for one in range(number, number + 1000))
    while text:
        text = text[os.write(1, text):]
    number += 1000
"""
"""Prints 10 MB a second, in numbered lines of 100 bytes (99 here, and the end)."""

FORKING = "(setsid sh -c '(setsid sleep 1000 &) ; sleep 1000' &); exec sleep 1000"
DEAF = "trap '' INT; while :; do sleep 1; done"


def check(truth: bool, text: str) -> None:
    """Print a result, and record a failure."""
    print(f"{'ok' if truth else 'WRONG':5}  {text}", flush=True)  # noqa: T201  # a program prints
    if not truth:
        PROBLEMS.append(text)


PROBLEMS: list[str] = []


def add_members(system: System, ends: Path) -> None:
    """Add fifty processes, four of which misbehave."""
    system.process("deaf", ["sh", "-c", DEAF], restart="on-failure")
    system.process("forking", ["sh", "-c", FORKING], term_after_sec=0.5)
    system.process("chatty", [sys.executable, "-S", "-c", CHATTY])
    system.process("failing", ["sh", "-c", "exit 1"], restart="always", max_delay_sec=1.0)
    for number in range(MEMBERS - 4):
        name = f"member{number:02}"
        argv = [sys.executable, "-S", "-c", TICKER, name, str(ends)]
        system.process(name, argv, restart="on-failure", min_delay_sec=0.1, max_delay_sec=1.0)


async def kill_some(system: System, seconds: float) -> int:
    """Kill a random one of five chosen processes every second; return how many were killed."""
    chance = random.Random(1)  # noqa: S311  # no secret
    chosen = chance.sample([f"member{number:02}" for number in range(MEMBERS - 4)], MEMBERS // 10)
    clock = SteadyClock()
    killed = 0
    for _ in range(round(seconds)):
        await clock.sleep(1.0)
        pid = system.member(chance.choice(chosen)).pid
        if pid is not None:
            os.kill(pid, signal.SIGKILL)
            killed += 1
    return killed


async def crowd(seconds: float, folder: Path) -> None:
    """Run fifty processes, and check what they leave behind."""
    ends, log = folder / "ends", folder / "log"
    system = System(
        "crowd",
        context=Context(transport="local"),
        log=SystemLog(
            open(os.devnull, "w", encoding="utf-8"),  # noqa: SIM115, PTH123, ASYNC230
            folder=log,
            max_bytes=50_000_000,
            backups=99,
        ),
    )
    async with system:
        add_members(system, ends)
        await system.ready()
        watcher = guardian()
        times = [cpu_s(), sum(watcher.cpu_times()[:2])]
        begin_ns = perf_ns()
        killed = await kill_some(system, seconds)
        took_s = (perf_ns() - begin_ns) / 1e9
        shares = [
            (cpu_s() - times[0]) / took_s,
            (sum(watcher.cpu_times()[:2]) - times[1]) / took_s,
        ]
        restarts = sum(
            status.restarts for name, status in system.status().items() if "member" in name
        )
        stop_ns = perf_ns()
    check(restarts >= killed - 1, f"{killed} processes killed, {restarts} restarts")
    check(
        shares[0] + shares[1] <= 0.05,
        f"supervisor {shares[0]:.1%} of a core, guardian {shares[1]:.1%}",
    )
    check(True, f"stopped in {(perf_ns() - stop_ns) / 1e9:.1f} s")
    check_crowd(ends, log, took_s)


def check_crowd(ends: Path, log: Path, seconds: float) -> None:
    """Check the order in which the members ended, and their logs."""
    order = ends.read_text(encoding="utf-8").split()
    check(order == sorted(order, reverse=True), f"{len(order)} members ended in reverse order")
    numbers = last = 0
    gaps = 0
    files = sorted(log.glob("chatty.log*"), key=age, reverse=True)
    for file in files:
        for match in re.finditer(rb" (\d{98})\n", file.read_bytes()):
            number = int(match[1])
            gaps += numbers > 0 and number != last + 1
            numbers, last = numbers + 1, number
    rate = numbers * 99 / seconds / 1e6
    check(
        gaps == 0 and numbers == last + 1,
        f"{numbers} lines in {len(files)} files, {rate:.1f} MB/s, none missing",
    )


def age(file: Path) -> int:
    """Return the number of a rotated file, which is higher for older ones."""
    return int(file.suffix[1:]) if file.suffix[1:].isdigit() else 0


def cpu_s() -> float:
    """Return the processor time of this process, in seconds."""
    usage = resource.getrusage(resource.RUSAGE_SELF)
    return usage.ru_utime + usage.ru_stime


async def start_and_stop(times: int) -> None:
    """Start and stop a small system again and again."""
    good = 0
    for _ in range(times):
        with open(os.devnull, "w", encoding="utf-8") as null:  # noqa: PTH123, ASYNC230
            context = Context(transport="local")
            async with System("brief", context=context, log=SystemLog(null)) as system:
                for number in range(5):
                    system.process(str(number), ["sleep", "1000"])
                await system.ready()
        states = [status.state for status in system.status().values()]
        good += states == ["stopped"] * 5 and not left(os.environ[MARK])
    check(good == times, f"{good} of {times} starts and stops, nothing left after each")


def moving(times: int, folder: Path) -> None:
    """End the system of a moving robot in three ways."""
    for how in ("stop", "Ctrl-C", "kill -9"):
        good = sum(
            end_moving(how, folder / f"{how.replace(' ', '')}{number}") for number in range(times)
        )
        check(
            good == times,
            f"{how}: {good} of {times} times the wheels got the commander's stop before they ended",
        )


def end_moving(how: str, record: Path) -> bool:
    """Start a robot, end its system while it moves, and return whether its wheels stopped."""
    env = {**os.environ, **isolated_environment(), "ROBOT_RECORD": str(record)}
    argv = [sys.executable, "-m", "tests.system.robot", "system"]
    with subprocess.Popen(argv, env=env, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        while not (record.exists() and "0.2" in record.read_text(encoding="utf-8")):
            assert process.stdout.readline(), "the robot did not start"
        reader = threading.Thread(target=process.stdout.read)
        reader.start()
        if how == "stop":
            command = [sys.executable, "-m", "aionode", "system", "stop", "--all"]
            subprocess.run(command, env=env, check=True, stdout=subprocess.DEVNULL)
        else:
            process.send_signal(signal.SIGINT if how == "Ctrl-C" else signal.SIGKILL)
        process.wait()
        while left(os.environ[MARK]):
            threading.Event().wait(0.05)
        reader.join()
    return record.read_text(encoding="utf-8").split() == ["0.2", "0.0", "end"]


def main() -> int:
    """Run all checks, and return the exit status."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=60.0, help="how long the crowd runs")
    parser.add_argument("--times", type=int, default=100, help="how many starts and stops")
    parser.add_argument(
        "--robots", type=int, default=10, help="how many moving robots of each kind"
    )
    options = parser.parse_args()
    share_bytecode()
    os.environ[MARK] = uuid4().hex
    with tempfile.TemporaryDirectory() as folder:
        if options.seconds:
            asyncio.run(crowd(options.seconds, Path(folder)))
            check(not left(os.environ[MARK]), "nothing is left")
        asyncio.run(start_and_stop(options.times))
        moving(options.robots, Path(folder))
    return 1 if PROBLEMS else 0


if __name__ == "__main__":
    sys.exit(main())
