"""Endpoints of two processes, and many processes, over the real transports."""

from __future__ import annotations

import asyncio
import json
import os
import subprocess
import sys
import time
from contextlib import asynccontextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from aionode import Context, Node
from aionode.interfaces.std_msgs.msg import String
from benchmarks.scale_parts.others import pause

if TYPE_CHECKING:
    from collections.abc import AsyncIterator, Callable

PAIRS: Final = (100, 1000, 3000)
PROCESSES: Final = (3, 10, 30)
WAIT_S: Final = 30.0
"""How long everything may take to be known before a row is incomplete."""


@dataclass(frozen=True)
class PairsRow:
    """What publishers here cost with as many subscriptions in another process.

    CPU is that of both processes with Zenoh's threads, for each pair. `growth` is the cost beside
    that of the row before.
    """

    route: str
    pairs: int
    make_cpu_ms: float
    make_ms: float
    destroy_cpu_ms: float
    threads: int
    growth: float
    missing: str


@dataclass(frozen=True)
class ProcessesRow:
    """How long many processes take that start at once.

    From the start of the last one until each knows the nodes of all, and is linked with all.
    """

    processes: int
    known_s: float
    growth: float
    missing: str


class Other:
    """Another process."""

    def __init__(self, process: asyncio.subprocess.Process) -> None:
        self._process = process

    async def answer(self) -> Any:
        """Wait for one line."""
        assert self._process.stdout is not None  # noqa: S101  # a pipe
        return json.loads(await self._process.stdout.readline())

    async def ask(self, line: str) -> Any:
        """Send a command, and return the answer."""
        assert self._process.stdin is not None  # noqa: S101  # a pipe
        self._process.stdin.write(f"{line}\n".encode())
        return await self.answer()


@asynccontextmanager
async def other(name: str, route: str) -> AsyncIterator[Other]:
    """Run another process meanwhile."""
    program = str(Path(__file__).with_name("others.py"))
    process = await asyncio.create_subprocess_exec(
        sys.executable, program, name, route, stdin=subprocess.PIPE, stdout=subprocess.PIPE
    )
    try:
        yield Other(process)
    finally:
        assert process.stdin is not None  # noqa: S101  # a pipe
        process.stdin.close()
        try:
            await asyncio.wait_for(process.wait(), 10)
        except TimeoutError:
            process.kill()
            await process.wait()


async def until(count: Callable[[], int], wanted: int) -> int:
    """Wait until `count()` has reached `wanted`, for `WAIT_S`; return it."""
    ends = time.perf_counter() + WAIT_S
    while (found := count()) < wanted and time.perf_counter() < ends:  # noqa: ASYNC110  # a limit
        await asyncio.sleep(0.02)
    return found


def lacking(what: str, found: int, wanted: int) -> str:
    """Describe what is incomplete; empty if nothing is."""
    return "" if found >= wanted else f"{what}: {found} of {wanted}"


async def listed_topics(count: int) -> str:
    """Return what `aionode topic list`, started now, lacks."""
    listing = await asyncio.create_subprocess_exec(
        sys.executable, "-m", "aionode", "topic", "list",
        stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
    )  # fmt: skip
    output, _ = await listing.communicate()
    found = sum(line.startswith("/t") and line[2:].isdigit() for line in output.decode().split())
    return lacking("topic list", found, count)


async def measure_pairs(route: str, count: int, before: PairsRow | None) -> PairsRow:
    """Return what `count` pairs cost."""
    async with (
        other("hearer", route) as hearer,
        Context(link=route == "link") as context,
        Node("sayer", context=context) as node,
    ):
        await hearer.answer()
        warm_up = node.create_publisher(String, "warm_up", 10)
        await warm_up.wait_for_subscribers()
        warm_up.publish(String(data="once"))
        began = time.perf_counter()
        start_s = time.process_time(), (await hearer.ask("time"))["cpu_s"]
        publishers = []
        for number in range(count):
            publishers.append(node.create_publisher(String, f"t{number}", 10))
            await pause(number)
        await hearer.ask(f"make {count}")
        matched = await until(
            lambda: sum(publisher.get_subscription_count() for publisher in publishers), count
        )
        routes = await until(
            lambda: sum(route in publisher.stats.routes.values() for publisher in publishers), count
        )
        make_s = time.perf_counter() - began
        made = await hearer.ask("time")
        make_cpu_s = time.process_time() - start_s[0] + made["cpu_s"] - start_s[1]
        missing = [
            lacking("graph", matched, count),
            lacking(f"over {route}", routes, count),
            await listed_topics(count),
        ]
        start_s = time.process_time(), (await hearer.ask("time"))["cpu_s"]
        for number, publisher in enumerate(publishers):
            publisher.destroy()
            await pause(number)
        gone = await hearer.ask("destroy")
        cpu_s = time.process_time() - start_s[0] + gone["cpu_s"] - start_s[1]
        make_cpu_ms = round(make_cpu_s / count * 1e3, 3)
        return PairsRow(
            route,
            count,
            make_cpu_ms,
            round(make_s / count * 1e3, 3),
            round(cpu_s / count * 1e3, 3),
            made["threads"],
            round(make_cpu_ms / before.make_cpu_ms, 2) if before is not None else 1.0,
            "; ".join(filter(None, missing)),
        )


async def measure_processes(count: int, before: ProcessesRow | None) -> ProcessesRow:
    """Return how long `count` processes take that start at once."""
    async with asyncio.TaskGroup() as tasks:

        async def one(number: int) -> tuple[float, float, list[int]]:
            async with other(f"node_{number}", "link") as process:
                await process.answer()
                await process.ask("join")
                started = time.perf_counter()
                while (found := await process.ask("found")) != [count, count - 1]:
                    if time.perf_counter() > started + WAIT_S:
                        break
                    await asyncio.sleep(0.05)
                known = time.perf_counter()
                await everyone.wait()  # a process that leaves would be missing in the others
                return started, known, found

        everyone = asyncio.Barrier(count)
        running = [tasks.create_task(one(number)) for number in range(count)]
    results = [task.result() for task in running]
    last_started = max(started for started, _, _ in results)
    known_s = round(max(known for _, known, _ in results) - last_started, 2)
    return ProcessesRow(
        count,
        known_s,
        round(known_s / max(before.known_s, 0.01), 2) if before is not None else 1.0,
        "; ".join(
            filter(
                None,
                (
                    lacking("nodes", min(found[0] for *_, found in results), count),
                    lacking("links", min(found[1] for *_, found in results), count - 1),
                ),
            )
        ),
    )


def measure_transports(*, quick: bool) -> tuple[list[PairsRow], list[ProcessesRow]]:
    """Measure, and print each row when it is there."""
    port = 29_000 + os.getpid() % 300 * 3  # seldom those of another run
    os.environ["AIONODE_MEETING_PORTS"] = f"{port},{port + 1},{port + 2}"
    pairs: list[PairsRow] = []
    print(
        f"\n{'route':>6} {'pairs':>6} {'make CPU':>11} {'make':>11} {'destroy CPU':>11} "
        f"{'threads':>8} {'growth':>7}"
    )
    for route in ("link", "zenoh"):
        before = None
        for count in PAIRS[:-1] if quick else PAIRS:
            row = before = asyncio.run(measure_pairs(route, count, before))
            pairs.append(row)
            print(
                f"{row.route:>6} {row.pairs:>6} {row.make_cpu_ms:8.3f} ms {row.make_ms:8.3f} ms "
                f"{row.destroy_cpu_ms:8.3f} ms {row.threads:>8} {row.growth:>6} x"
                f"{row.missing and '  INCOMPLETE: ' + row.missing}"
            )
    processes: list[ProcessesRow] = []
    print(f"\n{'processes':>9} {'all known':>10} {'growth':>7}")
    last = None
    for count in PROCESSES[:-1] if quick else PROCESSES:
        one = last = asyncio.run(measure_processes(count, last))
        processes.append(one)
        print(
            f"{one.processes:>9} {one.known_s:>8} s {one.growth:>6} x"
            f"{one.missing and '  INCOMPLETE: ' + one.missing}"
        )
    return pairs, processes
