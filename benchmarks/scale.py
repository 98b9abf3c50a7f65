"""What many nodes, endpoints and processes cost, and whether all are found in the end.

First many nodes in one process: time to create, memory, and their work while idle.

Every node has its parameter services and its log topic, as by default, and half as many publishers
and subscriptions as it has topics. Each size runs in its own process, so that the memory of one
does not include what another freed. Wake-ups are iterations of the event loop in one second in
which nothing happens, beyond those that end the second itself.

Then publishers with as many subscriptions in another process, over links and over Zenoh, each with
its own topic and all with one; clients that wait for services while other things change; and many
processes that start at once, with one context or several. Each row shows how its cost has grown
compared with the row before, and what is missing: in the graph, on the route, or in the answer of
``aionode topic list``. The program fails if anything is.

Run it with ``python benchmarks/scale.py``; ``--quick`` leaves out the largest size. It prints a
table and writes ``scale.json`` to ``benchmarks/results/``.
"""

from __future__ import annotations

import argparse
import asyncio
import gc
import json
import os
import selectors
import subprocess
import sys
import time
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Final

sys.path.insert(0, str(Path(__file__).parents[1]))  # run as a program, it finds its own parts

from aionode import Context, Node
from aionode.interfaces.std_msgs.msg import String
from aionode.testing import settle
from benchmarks.scale_parts.transports import measure_transports

RESULTS: Final = Path(__file__).parent / "results"
NODES: Final = (100, 300, 1000)
TOPICS: Final = 10
WARM_UP: Final = 20
"""Nodes created before, so that one-time costs do not count."""


@dataclass(frozen=True)
class Cost:
    """One row; times and memory are per node."""

    nodes: int
    make_ms: float
    start_ms: float
    topics_ms: float
    idle_kb: float
    idle_with_topics_kb: float
    wake_ups_per_s: int
    cpu_idle_percent: float
    publish_all_ms: float
    destroy_ms: float


class CountingSelector(selectors.DefaultSelector):
    """Counts the iterations of the event loop that uses it."""

    turns = 0

    def select(self, timeout: float | None = None) -> list[tuple[selectors.SelectorKey, int]]:
        """Wait like the selector of the system."""
        self.turns += 1
        return super().select(timeout)


def resident_kb() -> float:
    """Return the memory of this process; 0 where the system does not report it."""
    gc.collect()
    statm = Path("/proc/self/statm")
    if not statm.exists():
        return 0.0
    return int(statm.read_text(encoding="ascii").split()[1]) * os.sysconf("SC_PAGE_SIZE") / 1000


class Stopwatch:
    """Returns the time since it was last asked, in milliseconds per node."""

    def __init__(self, nodes: int) -> None:
        self._nodes = nodes
        self._since = time.perf_counter()

    def lap(self) -> float:
        """Return the time since the last lap."""
        before, self._since = self._since, time.perf_counter()
        return round((self._since - before) * 1e3 / self._nodes, 3)

    def skip(self) -> None:
        """Start a lap now."""
        self._since = time.perf_counter()


async def idle_second(selector: CountingSelector) -> tuple[int, float]:
    """Return how often the loop woke up in a second, and the share of a core it used."""
    await asyncio.sleep(0.1)
    turns, cpu = selector.turns, time.process_time()
    await asyncio.sleep(1)
    used = selector.turns - turns - 2  # one rings the alarm, one continues here
    return used, round(100 * (time.process_time() - cpu), 3)


async def measure(count: int, selector: CountingSelector) -> Cost:
    """Return the cost of `count` nodes."""
    context = Context(transport="local")
    async with context, asyncio.TaskGroup() as tasks:
        for number in range(WARM_UP):
            async with Node(f"warm_{number}", context=context) as node:
                node.create_publisher(String, "warm", 10)
                node.create_subscription(String, "warm", lambda _: None, 10)
        before_kb = resident_kb()
        watch = Stopwatch(count)
        nodes = [Node(f"node_{number}", context=context) for number in range(count)]
        make_ms = watch.lap()
        for node in nodes:
            tasks.create_task(node.run())
        await settle()
        start_ms = watch.lap()
        idle_kb = resident_kb()

        received = 0

        def receive(_: String) -> None:
            nonlocal received
            received += 1

        watch.skip()
        publishers = [
            node.create_publisher(String, f"from_{number}_{topic}", 10)
            for number, node in enumerate(nodes)
            for topic in range(TOPICS // 2)
        ]
        for number, node in enumerate(nodes):
            for topic in range(TOPICS // 2):
                node.create_subscription(
                    String, f"from_{(number + 1) % count}_{topic}", receive, 10
                )
        topics_ms = watch.lap()
        topics_kb = resident_kb()
        wake_ups, cpu = await idle_second(selector)

        watch.skip()
        for publisher in publishers:
            publisher.publish(String(data="hello"))
        await settle()
        publish_ms = watch.lap()
        if received != len(publishers):
            sys.exit(f"{received} of {len(publishers)} messages arrived")
        for node in nodes:
            node.destroy_node()
        await settle()
        return Cost(
            nodes=count,
            make_ms=make_ms,
            start_ms=start_ms,
            topics_ms=topics_ms,
            idle_kb=round((idle_kb - before_kb) / count, 1),
            idle_with_topics_kb=round((topics_kb - before_kb) / count, 1),
            wake_ups_per_s=wake_ups,
            cpu_idle_percent=cpu,
            publish_all_ms=publish_ms,
            destroy_ms=watch.lap(),
        )


def measure_here(count: int) -> Cost:
    """Return the cost of `count` nodes in this process."""
    selector = CountingSelector()
    with asyncio.Runner(loop_factory=lambda: asyncio.SelectorEventLoop(selector)) as runner:
        return runner.run(measure(count, selector))


def measure_elsewhere(count: int) -> Cost:
    """Return the cost of `count` nodes in a new process."""
    program = [sys.executable, __file__, "--nodes", str(count)]
    done = subprocess.run(program, check=True, capture_output=True, text=True)  # noqa: S603  # itself
    return Cost(**json.loads(done.stdout))


def print_table(rows: list[Cost]) -> None:
    """Print all rows."""
    print(
        f"{'nodes':>6} {'make':>9} {'start':>9} {'topics':>9} {'publish':>9} {'destroy':>9} "
        f"{'idle':>9} {'+topics':>9} {'wake-ups':>10} {'CPU idle':>9}"
    )
    for row in rows:
        times = " ".join(
            f"{value:6.3f} ms"
            for value in (
                row.make_ms,
                row.start_ms,
                row.topics_ms,
                row.publish_all_ms,
                row.destroy_ms,
            )
        )
        print(
            f"{row.nodes:>6} {times} {row.idle_kb:6.1f} kB {row.idle_with_topics_kb:6.1f} kB "
            f"{row.wake_ups_per_s:>8}/s {row.cpu_idle_percent:>7.2f} %"
        )
    print(f"\nTimes and memory are for each node; +topics is with {TOPICS} topics each.")


def main() -> None:
    """Measure all sizes, or one for another run of this program."""
    parser = argparse.ArgumentParser(description="What many nodes in one process cost.")
    parser.add_argument("--quick", action="store_true", help="leave out the largest size")
    parser.add_argument("--nodes", type=int, help="measure one size here, and print JSON")
    parser.add_argument("--results", type=Path, default=RESULTS, help="folder to write to")
    options = parser.parse_args()
    if options.nodes:
        print(json.dumps(asdict(measure_here(options.nodes))))
        return
    rows = [measure_elsewhere(count) for count in (NODES[:-1] if options.quick else NODES)]
    print_table(rows)
    options.results.mkdir(parents=True, exist_ok=True)
    path = options.results / "scale.json"
    tables = measure_transports(quick=options.quick)
    result = {
        name: [asdict(row) for row in table] for name, table in {"nodes": rows, **tables}.items()
    }
    path.write_text(json.dumps(result, indent=2), encoding="utf-8")
    print(f"Written: {path}")
    missing = [
        f"{name}: {row.missing}" for name, table in tables.items() for row in table if row.missing
    ]
    if missing:
        sys.exit(f"incomplete: {'; '.join(missing)}")


if __name__ == "__main__":
    main()
