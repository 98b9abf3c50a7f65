"""How many nodes, at which rates, a small computer has room for: a stand-in for one.

Everything runs on one core, beside programs that never rest: three of them by default, with the
same weight as any other, so that they take three quarters of it from a single process. With
``--quota`` a cgroup allows a part of every 10 ms besides, where cgroups can be written; with
``--fifo`` the nodes have real-time priority. A Raspberry Pi differs: its cores are slower, and it
has four.

Each process of a robot has one node, which sends messages to the next one at a rate, and receives
those of the one before. A message is late if its callback has it more than 10 ms after it was
published. A thread that sleeps for 10 ms shows how late the system itself is.

Run it with ``python benchmarks/small_computer.py``; ``--quick`` leaves out the larger robots, and
takes less time. It prints a table, and writes ``small_computer.json`` to ``benchmarks/results/``.
``python benchmarks/small_computer.py -- benchmarks/latency.py --quick`` runs another program in the
same conditions.
"""

from __future__ import annotations

import argparse
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Iterator

RESULTS: Final = Path(__file__).parent / "results"
NODES: Final = (2, 5, 10, 20)
RATES_HZ: Final = (10, 50, 100, 200)
BUSY: Final = 3
"""How many programs that never rest run beside."""
SECONDS: Final = 6.0
"""How long each rate is measured."""
SETTLE_S: Final = 5.0
"""Time from the last start until the first measurement."""
LATE_NS: Final = 10_000_000
PERIOD_US: Final = 10_000
"""The period of a cgroup's quota, in microseconds."""
GROUPS: Final = Path("/sys/fs/cgroup")

DOMAIN_ID: Final = "73"
"""A domain that seldom has other nodes."""

BUSY_ONE: Final = "while True: pass"

ROBOT_NODE: Final = """
import asyncio, json, sys, time
from aionode import Context, Node
from aionode.interfaces.std_msgs.msg import Int64

async def main(own, before):
    taken = []
    async with Node(f"node_{own}") as node:
        publisher = node.create_publisher(Int64, f"of_{own}", 10)
        node.create_subscription(
            Int64, f"of_{before}", lambda msg: taken.append(time.monotonic_ns() - msg.data), 10
        )
        print("ready", flush=True)
        loop = asyncio.get_running_loop()
        while line := await loop.run_in_executor(None, sys.stdin.readline):
            rate_hz, seconds = map(float, line.split())
            sent = 0

            def send():
                nonlocal sent
                sent += 1
                publisher.publish(Int64(data=time.monotonic_ns()))

            taken.clear()
            began = time.process_time()
            timer = node.create_timer(1 / rate_hz, send)
            await asyncio.sleep(seconds)
            used = time.process_time() - began
            timer.destroy()
            await asyncio.sleep(0.5)
            print(json.dumps({"sent": sent, "taken": taken, "used": used}), flush=True)

asyncio.run(main(*sys.argv[1:]))
"""


class Row(NamedTuple):
    """A robot at one rate.

    Attributes:
        nodes: Number of processes, each with one node.
        rate_hz: How often each sends a message.
        sent: Share of the messages that the rate demands, in percent: a late timer skips some.
        taken: Share of the sent messages that arrived, in percent.
        p50_ms: The median time from publishing to the callback.
        p99_ms: The 99th percentile.
        late: Share of the messages that took more than 10 ms, in percent.
        core: Processor time of all nodes, in percent of a core.
        memory_mb: Memory of a process, what it shares with others included.
        floor_ms: The 99th percentile by which a thread is late that sleeps for 10 ms.
    """

    nodes: int
    rate_hz: int
    sent: float
    taken: float
    p50_ms: float
    p99_ms: float
    late: float
    core: float
    memory_mb: float
    floor_ms: float


@contextmanager
def quota(percent: float) -> Iterator[None]:
    """Let this process and those that it starts have a part of one core in every 10 ms."""
    if (GROUPS / "cgroup.controllers").exists():
        group, amounts = GROUPS / f"aionode-{os.getpid()}", {"cpu.max": "{} {}"}
    else:
        group = GROUPS / "cpu" / f"aionode-{os.getpid()}"
        amounts = {"cpu.cfs_period_us": "{1}", "cpu.cfs_quota_us": "{0}"}
    group.mkdir()
    try:
        for name, form in amounts.items():
            text = form.format(round(PERIOD_US * percent / 100), PERIOD_US)
            (group / name).write_text(text, encoding="ascii")
        (group / "cgroup.procs").write_text(str(os.getpid()), encoding="ascii")
        yield
    finally:
        (group.parent / "cgroup.procs").write_text(str(os.getpid()), encoding="ascii")
        for _ in range(100):  # what it held may still be ending
            try:
                group.rmdir()
                break
            except OSError:
                time.sleep(0.1)


@contextmanager
def busy(count: int) -> Iterator[None]:
    """Run programs that never rest, outside of the quota."""
    programs = [subprocess.Popen([sys.executable, "-c", BUSY_ONE]) for _ in range(count)]  # noqa: S603  # itself
    try:
        yield
    finally:
        for program in programs:
            program.kill()
            program.wait()


class Member:
    """A process of the robot."""

    def __init__(self, own: int, before: int, *, first: bool) -> None:
        self.process = subprocess.Popen(  # noqa: S603  # itself
            [sys.executable, "-c", ROBOT_NODE, str(own), str(before)],
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True,
        )  # fmt: skip
        if first:
            os.sched_setscheduler(self.process.pid, os.SCHED_FIFO, os.sched_param(1))

    def ask(self, line: str) -> None:
        """Send a command."""
        assert self.process.stdin is not None  # noqa: S101  # a pipe
        self.process.stdin.write(f"{line}\n")
        self.process.stdin.flush()

    def answer(self) -> str:
        """Return its next answer."""
        assert self.process.stdout is not None  # noqa: S101  # a pipe
        line = self.process.stdout.readline()
        if not line:
            sys.exit(f"a node has ended with status {self.process.wait()}")
        return line

    def memory_mb(self) -> float:
        """Return its memory, what it shares with others included."""
        status = Path(f"/proc/{self.process.pid}/status").read_text(encoding="ascii")
        return next(int(line.split()[1]) for line in status.splitlines() if "VmRSS" in line) / 1000

    def end(self) -> None:
        """Let it end."""
        self.process.communicate("")


def lateness_ns(seconds: float) -> list[int]:
    """Return by how much a thread is late that sleeps for 10 ms, again and again."""
    ends_ns = time.monotonic_ns() + round(seconds * 1e9)
    late = []
    while (began_ns := time.monotonic_ns()) < ends_ns:
        time.sleep(LATE_NS / 1e9)
        late.append(time.monotonic_ns() - began_ns - LATE_NS)
    return late


def percentile_ms(values: list[int], percent: int) -> float:
    """Return a percentile in milliseconds; infinite if there are no values."""
    if len(values) < 2:
        return float("inf")
    return round(statistics.quantiles(values, n=100)[percent - 1] / 1e6, 2)


def robot(nodes: int, rates_hz: tuple[int, ...], seconds: float, *, first: bool) -> Iterator[Row]:
    """Measure a robot at each rate; with real-time priority if it comes `first`."""
    with ExitStack() as stack:
        members = []
        for number in range(nodes):
            member = Member(number, (number - 1) % nodes, first=first)
            stack.callback(member.end)
            member.answer()
            members.append(member)
        time.sleep(SETTLE_S)
        for rate_hz in rates_hz:
            for member in members:
                member.ask(f"{rate_hz} {seconds}")
            floor = lateness_ns(seconds)
            found: list[dict[str, Any]] = [json.loads(member.answer()) for member in members]
            taken = [each for one in found for each in one["taken"]]
            sent = sum(one["sent"] for one in found)
            yield Row(
                nodes,
                rate_hz,
                round(100 * sent / (nodes * rate_hz * seconds), 1),
                round(100 * len(taken) / max(sent, 1), 1),
                percentile_ms(taken, 50),
                percentile_ms(taken, 99),
                round(100 * sum(each > LATE_NS for each in taken) / max(len(taken), 1), 2),
                round(100 * sum(one["used"] for one in found) / seconds, 1),
                round(statistics.mean(member.memory_mb() for member in members), 1),
                percentile_ms(floor, 99),
            )


def table(rows: list[Row]) -> Iterator[str]:
    """Return the lines of the table."""
    yield (
        "| nodes | each, Hz | sent | arrived | p50, ms | p99, ms | over 10 ms "
        "| all nodes, of a core | memory of each | *sleeping thread, p99 late, ms* |"
    )
    yield "|" + " ---: |" * len(Row._fields)
    for row in rows:
        yield (
            f"| {row.nodes} | {row.rate_hz} | {row.sent:g} % | {row.taken:g} % | {row.p50_ms:g} "
            f"| {row.p99_ms:g} | {row.late:g} % | {row.core:g} % | {row.memory_mb:.0f} MB "
            f"| {row.floor_ms:g} |"
        )


def main() -> None:
    """Measure, or run another program, and print."""
    parser = argparse.ArgumentParser(description="What a small computer has room for.")
    parser.add_argument("--quick", action="store_true", help="small robots, for 3 s at each rate")
    parser.add_argument("--core", type=int, default=0, help="the core that everything runs on")
    parser.add_argument("--busy", type=int, default=BUSY, help="number of programs beside")
    parser.add_argument(
        "--quota", type=float, metavar="PERCENT", help="part of the core in every 10 ms"
    )
    parser.add_argument(
        "--fifo", action="store_true", help="give the nodes real-time priority, as `chrt -f 1` does"
    )
    parser.add_argument("--results", type=Path, default=RESULTS, help="folder to write to")
    parser.add_argument("program", nargs="*", help="a Python program to run instead")
    options = parser.parse_args()
    if not hasattr(os, "sched_setaffinity"):
        sys.exit("This system cannot keep programs on one core; run it on Linux")
    os.sched_setaffinity(0, {options.core})
    with ExitStack() as stack:
        stack.enter_context(busy(options.busy))
        if options.quota is not None:
            stack.enter_context(quota(options.quota))
        if options.program:
            program = [sys.executable, *options.program]
            sys.exit(subprocess.run(program, check=False).returncode)  # noqa: S603  # the user's
        os.environ["ROS_DOMAIN_ID"] = DOMAIN_ID
        os.environ["TMPDIR"] = stack.enter_context(tempfile.TemporaryDirectory())
        rows: list[Row] = []
        for nodes in NODES[: 2 if options.quick else None]:
            rows += robot(nodes, RATES_HZ, 3.0 if options.quick else SECONDS, first=options.fifo)
    print("\n".join(table(rows)))
    options.results.mkdir(parents=True, exist_ok=True)
    path = options.results / "small_computer.json"
    path.write_text(json.dumps([row._asdict() for row in rows], indent=2), encoding="utf-8")
    print(f"Written: {path}")


if __name__ == "__main__":
    main()
