"""What watching a robot costs, and what a busy computer puts into its log.

``python benchmarks/observe.py`` starts 20 processes with 200 topics and 5 kHz of messages in sum,
and compares the processor time that they take with and without ``aionode top --json`` beside them,
in turns. With ``--busy`` it runs a robot beside eight programs that never wait, and counts the
lines of its log about that.
"""

from __future__ import annotations

import argparse
import json
import os
import signal
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, Final

ROBOT: Final = """
import sys
import aionode
from aionode.interfaces.std_msgs.msg import Int32

class Part(aionode.Node):
    def __init__(self):
        number = int(sys.argv[1])
        super().__init__(f"part_{number}")
        self.outlets = [self.create_publisher(Int32, f"/topic_{number}_{i}", 10) for i in range(10)]
        for outlet in self.outlets:
            self.create_subscription(Int32, outlet.topic_name, lambda _: None, 10)
        self.create_timer(0.04, self.speak)
        print("ready", flush=True)

    def speak(self):
        for outlet in self.outlets:
            outlet.publish(Int32(data=1))

aionode.run(Part)
"""
"""A process of the robot: ten topics with 25 messages a second each."""

PROCESSES: Final = 20
SETTLE_S: Final = 5.0
TICKS: Final = os.sysconf("SC_CLK_TCK")
REPORTS: Final = ("wait for a processor", "blocked the event loop")
"""What the lines of a log say about a busy computer."""


@contextmanager
def running(*command: str, **options: Any) -> Iterator[subprocess.Popen[str]]:
    """Run a program, and end it with the block as Ctrl-C does."""
    process = subprocess.Popen([sys.executable, *command], text=True, **options)  # noqa: S603  # ours
    try:
        yield process
    finally:
        process.send_signal(signal.SIGINT)
        process.wait(20)


def cpu_s(processes: list[subprocess.Popen[str]]) -> float:
    """Return the processor time that processes have taken so far, in seconds."""
    total = 0
    for process in processes:
        fields = Path(f"/proc/{process.pid}/stat").read_text().rpartition(")")[2].split()
        total += int(fields[11]) + int(fields[12])
    return total / TICKS


def share(processes: list[subprocess.Popen[str]], seconds: float) -> float:
    """Return how much of one processor processes take, in percent."""
    before, start = cpu_s(processes), time.monotonic()
    time.sleep(seconds)
    return 100 * (cpu_s(processes) - before) / (time.monotonic() - start)


def watch(seconds: float, times: int) -> int:
    """Print what watching costs; return 1 if it is more than it may be."""
    robot: list[subprocess.Popen[str]] = []
    for number in range(PROCESSES):
        command = [sys.executable, "-c", ROBOT, str(number)]
        robot.append(subprocess.Popen(command, stdout=subprocess.PIPE, text=True))  # noqa: S603  # ours
    try:
        for each in robot:
            assert each.stdout is not None  # noqa: S101  # it has a pipe
            each.stdout.readline()
        time.sleep(SETTLE_S)
        alone, watched, watching, seen = [], [], [], {}
        for _ in range(times):
            alone.append(share(robot, seconds))
            with (
                tempfile.TemporaryFile("w+") as shown,
                running("-m", "aionode", "top", "--json", stdout=shown) as top,
            ):
                time.sleep(SETTLE_S)
                watched.append(share(robot, seconds))
                watching.append(share([top], seconds))
                shown.seek(0)
                seen = json.loads(shown.readlines()[-1])
    finally:
        for each in robot:
            each.send_signal(signal.SIGINT)
        for each in robot:
            each.wait(20)
    hertz = sum(topic["Hz"] for topic in seen["topics"])
    costs = [with_top - without for without, with_top in zip(alone, watched, strict=True)]
    cost, own = statistics.median(costs), statistics.median(watching)
    print(
        f"shown: {len(seen['processes'])} processes, {len(seen['topics'])} topics, {hertz:.0f} Hz"
    )
    print(f"the robot alone: {', '.join(f'{each:.1f}' for each in alone)} % of a processor")
    print(f"watched: {', '.join(f'{each:.1f}' for each in watched)} %")
    print(f"watching costs {cost:.1f} % in the processes (limit 2), {own:.1f} % in top (limit 5)")
    return int(cost > 2 or own > 5)


def busy(seconds: float) -> int:
    """Print what a busy computer puts into a robot's log; return 1 if it is more than two lines."""
    burners = [
        subprocess.Popen([sys.executable, "-c", "while True: pass"])  # ours
        for _ in range(8)
    ]
    try:
        with tempfile.TemporaryFile("w+") as log:
            rover = ("-m", "aionode.examples.rover")
            with running(*rover, stdout=log, stderr=subprocess.STDOUT):
                time.sleep(seconds)
                load = os.getloadavg()[0]
            log.seek(0)
            lines = log.readlines()
    finally:
        for each in burners:
            each.kill()
            each.wait()
    found = [line.strip() for line in lines if any(report in line for report in REPORTS)]
    print(f"load {load:.1f} on {os.cpu_count()} processors for {seconds:g} s: {len(lines)} lines, "
          f"{len(found)} about it (limit 2)", *found, sep="\n")  # fmt: skip
    return int(len(found) > 2)


def main() -> int:
    """Measure, and return the exit status."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--busy", action="store_true", help="measure the log of a busy computer")
    parser.add_argument("--seconds", type=float, default=10.0, help="how long each look lasts")
    parser.add_argument("--times", type=int, default=3, help="how often it is looked")
    options = parser.parse_args()
    if options.busy:
        return busy(max(options.seconds, 60.0))
    return watch(options.seconds, options.times)


if __name__ == "__main__":
    sys.exit(main())
