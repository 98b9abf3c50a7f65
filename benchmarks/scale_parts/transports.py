"""Endpoints of two processes, and many processes, over the real transports."""

from __future__ import annotations

import asyncio
import json
import os
import statistics
import subprocess
import sys
import time
from contextlib import AsyncExitStack, asynccontextmanager, suppress
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from aionode import Context, Node
from aionode.interfaces.std_msgs.msg import String
from aionode.interfaces.std_srvs.srv import Trigger
from aionode.testing import settle
from benchmarks.scale_parts.others import pause

if TYPE_CHECKING:
    from collections.abc import AsyncIterator, Callable, Sequence

PAIRS: Final = (100, 1000, 3000)
CROWDS: Final = (30, 100, 300)
"""How many publishers and subscriptions of one topic."""

WAITERS: Final = (100, 300, 1000)
PROCESSES: Final = ((3, 1), (10, 1), (30, 1), (5, 5), (10, 10), (100, 1))
"""How many processes, and how many contexts in each."""

SYSTEMS: Final = (10, 30, 100)
"""How many processes have `TOPICS` topics each."""

TOPICS: Final = 10

SETTLE_S: Final = 15.0
"""Time after the last change until processes are idle."""

IDLE_S: Final = 50.0
IDLE_S_EACH: Final = 15.0
MAX_IDLE_S: Final = 300.0
"""How long idle processes are looked at: the first number, some more for each process, and this
at most. Each process gives a sign of life once in this time, except the last of more than 17."""

CHANGES: Final = 100
"""How many changes of the graph are measured."""

WAIT_S: Final = 60.0
"""How long everything may take to be found before a row is incomplete."""


@dataclass(frozen=True)
class PairsRow:
    """What publishers here cost with as many subscriptions in another process.

    CPU is that of both processes with Zenoh's threads, for each pair. `growth` is the cost beside
    that of the row before, and `hand_over_ms` what passes after all are matched until all have
    their route.
    """

    route: str
    pairs: int
    make_cpu_ms: float
    make_ms: float
    hand_over_ms: float
    destroy_cpu_ms: float
    threads: int
    growth: float
    missing: str


@dataclass(frozen=True)
class CrowdRow:
    """What publishers here cost with as many subscriptions to their topic in another process.

    CPU of both processes, for each publisher and subscription that are matched, which is the square
    of their number.
    """

    route: str
    endpoints: int
    make_cpu_us: float
    growth: float
    missing: str


@dataclass(frozen=True)
class WaitersRow:
    """How much CPU a change of the graph costs while clients wait for services of other names."""

    waiters: int
    change_cpu_us: float
    growth: float
    missing: str


@dataclass(frozen=True)
class ProcessesRow:
    """How long many contexts take whose processes start at once.

    Measured from the start of the last one until each knows the nodes of all, and is linked with
    all. CPU is that of all of them since their start, for each; their start itself is most of it.
    """

    processes: int
    contexts: int
    known_s: float
    cpu_s: float
    growth: float
    missing: str


@dataclass(frozen=True)
class SystemRow:
    """What each of many processes costs that has topics and is idle.

    Each publishes its topics, and subscribes to those of the next one. The memory for each topic is
    what a process has grown by since it knew the nodes and no topics. `growth` is that of the
    processor.
    """

    processes: int
    topics: int
    known_s: float
    core_percent: float
    kb_each_topic: float
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
async def other(name: str, route: str, contexts: int = 1) -> AsyncIterator[Other]:
    """Run another process within the block."""
    program = str(Path(__file__).with_name("others.py"))
    process = await asyncio.create_subprocess_exec(
        sys.executable, program, name, route, str(contexts),
        stdin=subprocess.PIPE, stdout=subprocess.PIPE,
    )  # fmt: skip
    try:
        yield Other(process)
    finally:
        assert process.stdin is not None  # noqa: S101  # a pipe
        process.stdin.close()
        try:
            await asyncio.wait_for(process.wait(), 10)
        except TimeoutError:
            with suppress(ProcessLookupError):  # it has just ended
                process.kill()
            await process.wait()


async def until(count: Callable[[], int], wanted: int) -> int:
    """Wait until `count()` has reached `wanted`, for `WAIT_S`; return it."""
    ends = time.perf_counter() + WAIT_S
    while (found := count()) < wanted and time.perf_counter() < ends:  # noqa: ASYNC110  # a limit
        await asyncio.sleep(0.02)
    return found


def lacking(what: str, found: float, wanted: int) -> str:
    """Describe what is incomplete; empty if nothing is."""
    return "" if found >= wanted else f"{what}: {found:g} of {wanted}"


async def listed_topics(count: int) -> str:
    """Return what a newly started `aionode topic list` lacks."""
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
        matched_s = time.perf_counter()
        routes = await until(
            lambda: sum(route in publisher.stats.routes.values() for publisher in publishers), count
        )
        make_s = time.perf_counter() - began
        hand_over_s = time.perf_counter() - matched_s
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
            round(hand_over_s / count * 1e3, 3),
            round(cpu_s / count * 1e3, 3),
            made["threads"],
            round(make_cpu_ms / before.make_cpu_ms, 2) if before is not None else 1.0,
            "; ".join(filter(None, missing)),
        )


async def measure_crowd(route: str, count: int, before: CrowdRow | None) -> CrowdRow:
    """Return what `count` publishers and subscriptions of one topic cost."""
    async with (
        other("hearer", route) as hearer,
        Context(link=route == "link") as context,
        Node("sayer", context=context) as node,
    ):
        await hearer.answer()
        warm_up = node.create_publisher(String, "warm_up", 10)
        await warm_up.wait_for_subscribers()
        start_s = time.process_time(), (await hearer.ask("time"))["cpu_s"]
        publishers = [node.create_publisher(String, "crowd", 10) for _ in range(count)]
        await hearer.ask(f"crowd {count}")
        matched = await until(publishers[-1].get_subscription_count, count)
        made = await hearer.ask("time")
        cpu_s = time.process_time() - start_s[0] + made["cpu_s"] - start_s[1]
        routed = sum(route in way for way in publishers[-1].stats.routes.values())
        cpu_us = round(cpu_s / count**2 * 1e6, 1)
        return CrowdRow(
            route,
            count,
            cpu_us,
            round(cpu_us / before.make_cpu_us, 2) if before is not None else 1.0,
            lacking("graph", matched, count) if route == "zenoh" else lacking("link", routed, 1),
        )


def trigger(_: Any, response: Any) -> Any:
    """Answer immediately."""
    return response


async def measure_waiters(count: int, before: WaitersRow | None) -> WaitersRow:
    """Return the cost of a change of the graph with `count` waiting clients."""
    async with Context(transport="local") as context, Node("n", context=context) as node:
        clients = [node.create_client(Trigger, f"wanted_{number}") for number in range(count)]
        async with asyncio.TaskGroup() as tasks:
            waits = [tasks.create_task(client.wait_for_service()) for client in clients]
            await settle()
            began = time.process_time()
            for number in range(CHANGES):
                node.create_publisher(String, f"t{number}", 10)
                await asyncio.sleep(0)
            change_us = round((time.process_time() - began) / CHANGES * 1e6, 1)
            for client in clients:
                node.create_service(Trigger, client.srv_name, trigger)
            await asyncio.wait(waits, timeout=WAIT_S)
            ready = sum(wait.done() for wait in waits)
            for wait in waits:
                wait.cancel()
        return WaitersRow(
            count,
            change_us,
            round(change_us / before.change_cpu_us, 2) if before is not None else 1.0,
            lacking("services found", ready, count),
        )


async def measure_processes(size: tuple[int, int], before: ProcessesRow | None) -> ProcessesRow:
    """Return how long processes that start at once take: their number, and contexts in each."""
    count, contexts = size
    everyone = asyncio.Barrier(count)
    wanted = count * contexts
    async with asyncio.TaskGroup() as tasks:

        async def one(number: int) -> tuple[float, float, list[float]]:
            async with other(f"node_{number}", "link", contexts) as process:
                await process.answer()
                await process.ask("join")
                started = time.monotonic()  # the same clock in all processes
                found = await process.ask(f"meet {wanted} {WAIT_S}")
                await everyone.wait()  # a process that leaves would be missing in the others
                return started, found[3], found

        running = [tasks.create_task(one(number)) for number in range(count)]
    results = [task.result() for task in running]
    last_started = max(started for started, _, _ in results)
    known_s = round(max(known for _, known, _ in results) - last_started, 2)
    return ProcessesRow(
        count,
        wanted,
        known_s,
        round(sum(found[2] for *_, found in results) / wanted, 2),
        round(known_s / max(before.known_s, 0.01), 2) if before is not None else 1.0,
        "; ".join(
            filter(
                None,
                (
                    lacking("nodes", min(found[0] for *_, found in results), wanted),
                    lacking("links", min(found[1] for *_, found in results), wanted - 1),
                ),
            )
        ),
    )


async def measure_system(count: int, before: SystemRow | None) -> SystemRow:
    """Return what each of `count` processes costs that have `TOPICS` topics each."""
    async with AsyncExitStack() as stack:
        processes = []
        for number in range(count):
            process = await stack.enter_async_context(other(f"node_{number}", "link"))
            await process.answer()
            processes.append(process)

        async def all_asked(*lines: str) -> list[Any]:
            lines = lines if len(lines) == count else lines * count
            async with asyncio.TaskGroup() as tasks:
                asked = [
                    tasks.create_task(process.ask(line))
                    for process, line in zip(processes, lines, strict=True)
                ]
            return [task.result() for task in asked]

        without = await all_asked(f"idle {SETTLE_S}")
        began = time.perf_counter()
        await all_asked(*(f"topics {TOPICS} {each} {(each + 1) % count}" for each in range(count)))
        known = await all_asked(f"know {count * TOPICS} {WAIT_S}")
        known_s = time.perf_counter() - began
        await all_asked(f"idle {SETTLE_S}")
        idle = await all_asked(f"idle {min(IDLE_S + IDLE_S_EACH * count, MAX_IDLE_S)}")
        grown = [now["kb"] - then["kb"] for now, then in zip(idle, without, strict=True)]
        core = statistics.mean(each["core"] for each in idle)
        return SystemRow(
            count,
            count * TOPICS,
            round(known_s, 2),
            round(core, 3),
            round(statistics.mean(grown) / count / TOPICS, 2),
            round(core / before.core_percent, 2) if before is not None else 1.0,
            lacking("topics", min(known), count * TOPICS),
        )


def print_row(row: Any, *, header: bool) -> None:
    """Print a row, and before the first one the names of its columns."""
    columns = {name: value for name, value in asdict(row).items() if name != "missing"}
    if header:
        print("\n" + " ".join(f"{name:>15}" for name in columns))
    print(
        " ".join(f"{value:>15}" for value in columns.values())
        + (row.missing and f"  INCOMPLETE: {row.missing}"),
        flush=True,
    )


def measure_transports(*, quick: bool) -> dict[str, list[Any]]:
    """Measure, print each row when it is there, and return the rows of each table."""
    port = 29_000 + os.getpid() % 300 * 3  # seldom those of another run
    os.environ["AIONODE_MEETING_PORTS"] = f"{port},{port + 1},{port + 2}"
    tables: dict[str, list[Any]] = {}

    def measure(name: str, sizes: Sequence[Any], work: Callable[[Any, Any], Any]) -> None:
        rows: list[Any] = []
        for size in sizes[:-1] if quick else sizes:
            rows.append(asyncio.run(work(size, rows[-1] if rows else None)))
            print_row(rows[-1], header=len(rows) == 1)
        tables[name] = rows

    for route in ("link", "zenoh"):
        measure(f"pairs_{route}", PAIRS, partial(measure_pairs, route))
    for route in ("link", "zenoh"):
        measure(f"crowd_{route}", CROWDS, partial(measure_crowd, route))
    measure("waiters", WAITERS, measure_waiters)
    measure("processes", PROCESSES, measure_processes)
    measure("systems", SYSTEMS, measure_system)
    return tables
