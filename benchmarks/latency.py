"""How long a message takes from publish to callback in one process, and how many pass per second.

Each row is compared with a bare ``asyncio.Queue`` hop at the same rate, in the same run: the time
of one `put_nowait` and one awaiting `get` is the least that any node on asyncio could reach. The
guidance for robots is 10 ms from a message to the end of its callback.

Run it with ``python benchmarks/latency.py``. It prints a table and writes ``latency.json`` and
``latency.png`` to ``benchmarks/results/``; ``--quick`` takes a tenth of the time, for a first look.
"""

from __future__ import annotations

import argparse
import asyncio
import gc
import json
import platform
import statistics
import sys
import time
from dataclasses import asdict, dataclass
from importlib import metadata
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from aionode import Context, Node
from aionode.interfaces.std_msgs.msg import Float64MultiArray, String, UInt8MultiArray

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable

    from aionode.message import Message

GUIDANCE_NS: Final = 10_000_000
QUEUE: Final = "asyncio.Queue"
RATES_HZ: Final = (100, 1_000, 10_000)
SECONDS: Final = 3.0
ROUNDS: Final = 3
THROUGHPUT_MESSAGES: Final = 300_000
THROUGHPUT_BATCH: Final = 500
RESULTS: Final = Path(__file__).parent / "results"
PERCENTILES: Final = (50, 90, 99)


@dataclass(frozen=True)
class Latency:
    """One row: the payload, the rate, and the latencies in nanoseconds."""

    loop: str
    rate_hz: int
    payload: str
    count: int
    p50_ns: int
    p90_ns: int
    p99_ns: int
    max_ns: int
    ratio_to_queue: float


@dataclass(frozen=True)
class Throughput:
    """One row: messages per second from one publisher to one plain function."""

    loop: str
    what: str
    messages: int
    per_second: int


Samples = dict[tuple[str, int, str], list[int]]


def payloads() -> dict[str, Message]:
    """Return the messages to send, by their names in the table."""
    return {
        "String 16 B": String(data="x" * 16),
        "String 1 KiB": String(data="x" * 1024),
        "bytes 1 MiB, shared": UInt8MultiArray(data=bytes(1 << 20)),
        "float64[1000], copied": Float64MultiArray(data=np.zeros(1000)),
    }


async def paced(rate_hz: int, count: int, send: Callable[[], None]) -> None:
    """Call `send` `count` times at `rate_hz`; calls that are due together are made together."""
    loop = asyncio.get_running_loop()
    start = loop.time()
    for index in range(count):
        ahead = start + index / rate_hz - loop.time()
        if ahead > 0:
            await asyncio.sleep(ahead)
        send()


async def queue_hop(rate_hz: int, count: int) -> list[int]:
    """Return how long each of `count` hops through a bare queue took."""
    queue: asyncio.Queue[int] = asyncio.Queue(1000)
    samples: list[int] = []

    async def read() -> None:
        while len(samples) < count:
            stamp = await queue.get()
            samples.append(time.perf_counter_ns() - stamp)

    async with asyncio.TaskGroup() as tasks:
        tasks.create_task(read())
        await paced(rate_hz, count, lambda: queue.put_nowait(time.perf_counter_ns()))
    return samples


async def node_hop(rate_hz: int, count: int, msg: Message) -> list[int]:
    """Return how long each of `count` messages took from publish to its callback."""
    stamps: list[int] = []
    samples: list[int] = []
    done = asyncio.Event()

    def callback(_msg: Message) -> None:
        samples.append(time.perf_counter_ns() - stamps[len(samples)])
        if len(samples) == count:
            done.set()

    # If the machine stalls for a while, everything waits, and nothing is dropped.
    context = Context(transport="local", queue_bytes=count * 2**21)
    async with Node("writer", context=context) as writer, Node("reader", context=context) as reader:
        reader.create_subscription(type(msg), "/bench", callback, count)
        publisher = writer.create_publisher(type(msg), "/bench", 1000)

        def send() -> None:
            stamps.append(time.perf_counter_ns())
            publisher.publish(msg)

        await paced(rate_hz, count, send)
        await done.wait()
    return samples


async def measure_latency(loop: str, seconds: float, samples: Samples) -> None:
    """Add the samples of every rate and payload, alternating between queue and aionode."""
    for rate_hz in RATES_HZ:
        count = max(20, int(rate_hz * seconds / ROUNDS))
        for _ in range(ROUNDS):
            await collect(samples, (loop, rate_hz, QUEUE), queue_hop(rate_hz, count))
            for name, msg in payloads().items():
                await collect(samples, (loop, rate_hz, name), node_hop(rate_hz, count, msg))


async def collect(
    samples: Samples, key: tuple[str, int, str], measurement: Awaitable[list[int]]
) -> None:
    """Add the results of one measurement, after collecting the garbage of the previous one."""
    gc.collect()
    samples.setdefault(key, []).extend(await measurement)


async def queue_throughput(messages: int) -> float:
    """Return how many items per second pass through a bare queue to one awaiting reader."""
    queue: asyncio.Queue[int] = asyncio.Queue(2 * THROUGHPUT_BATCH)

    async def read() -> None:
        for _ in range(messages):
            await queue.get()

    start = time.perf_counter()
    async with asyncio.TaskGroup() as tasks:
        tasks.create_task(read())
        for _ in range(messages):
            await queue.put(1)
    return messages / (time.perf_counter() - start)


async def node_throughput(messages: int) -> float:
    """Return how many messages per second pass from one publisher to one plain function."""
    msg = String(data="x" * 16)
    received = 0
    done = asyncio.Event()

    def callback(_msg: String) -> None:
        nonlocal received
        received += 1
        if received == messages:
            done.set()

    context = Context(transport="local")
    async with Node("writer", context=context) as writer, Node("reader", context=context) as reader:
        subscription = reader.create_subscription(String, "/bench", callback, 2 * THROUGHPUT_BATCH)
        publisher = writer.create_publisher(String, "/bench", 10)
        start = time.perf_counter()
        for sent in range(1, messages + 1):
            publisher.publish(msg)
            if sent % THROUGHPUT_BATCH == 0:
                while received + THROUGHPUT_BATCH < sent:  # noqa: ASYNC110 - an event costs more
                    await asyncio.sleep(0)
        await done.wait()
        elapsed = time.perf_counter() - start
        if subscription.stats.dropped:
            sys.exit(f"{subscription.stats.dropped} messages were dropped: no throughput to report")
    return messages / elapsed


async def measure_throughput(loop: str, messages: int) -> list[Throughput]:
    """Return the best of three runs of queue and node: the least disturbed one."""
    measurements = (
        (QUEUE, queue_throughput),
        ("publisher to callback", node_throughput),
    )
    return [
        Throughput(loop, what, messages, int(max([await run(messages) for _ in range(ROUNDS)])))
        for what, run in measurements
    ]


def summarized(samples: Samples) -> list[Latency]:
    """Return one row for each list of samples."""
    rows = []
    for (loop, rate_hz, payload), values in samples.items():
        p50, p90, p99 = (int(np.percentile(values, percent)) for percent in PERCENTILES)
        queue_p50 = statistics.median(samples[loop, rate_hz, QUEUE])
        rows.append(
            Latency(
                loop, rate_hz, payload, len(values), p50, p90, p99, max(values),
                round(p50 / queue_p50, 2),
            )
        )  # fmt: skip
    return rows


def loops() -> dict[str, Callable[[], asyncio.AbstractEventLoop]]:
    """Return the factory of each installed event loop."""
    found: dict[str, Callable[[], asyncio.AbstractEventLoop]] = {"asyncio": asyncio.new_event_loop}
    try:
        import uvloop
    except ImportError:
        print("uvloop is not installed: asyncio only", file=sys.stderr)
    else:
        found["uvloop"] = uvloop.new_event_loop
    return found


def environment() -> dict[str, str]:
    """Return the machine and versions that the figures depend on."""
    packages = ("aionode", "uvloop", "numpy", "msgspec")
    return {
        "python": platform.python_version(),
        "system": platform.platform(),
        "processor": processor(),
    } | {name: version(name) for name in packages}


def version(package: str) -> str:
    """Return the installed version of a package, or ``not installed``."""
    try:
        return metadata.version(package)
    except metadata.PackageNotFoundError:
        return "not installed"


def processor() -> str:
    """Return the processor's name, as far as the system tells."""
    info = Path("/proc/cpuinfo")
    if info.exists():
        for line in info.read_text(encoding="utf-8").splitlines():
            if line.startswith("model name"):
                return line.partition(":")[2].strip()
    return platform.processor() or "unknown"


def print_tables(latencies: list[Latency], throughputs: list[Throughput]) -> None:
    """Print all rows, in microseconds and messages a second."""
    print(
        f"{'loop':8} {'rate':>9}  {'payload':22} {'p50 µs':>9} {'p90 µs':>9} {'p99 µs':>9} "
        f"{'max µs':>9} {'x queue':>8}  under 10 ms"
    )
    for row in latencies:
        times = " ".join(
            f"{value / 1e3:9.1f}" for value in (row.p50_ns, row.p90_ns, row.p99_ns, row.max_ns)
        )
        kept = "all" if row.max_ns < GUIDANCE_NS else "p99" if row.p99_ns < GUIDANCE_NS else "no"
        print(
            f"{row.loop:8} {row.rate_hz:>6} Hz  {row.payload:22} {times} "
            f"{row.ratio_to_queue:8.2f}  {kept}"
        )
    print()
    for each in throughputs:
        print(f"{each.loop:8} {each.what:24} {each.per_second:>10,} messages/s")


def draw(samples: Samples, path: Path) -> None:
    """Plot the distributions: how many of a thousand messages took longer than a time."""
    import matplotlib as mpl

    mpl.use("Agg")
    from matplotlib import pyplot as plt

    names = list(dict.fromkeys(loop for loop, _, _ in samples))
    figure, axes = plt.subplots(
        len(RATES_HZ), len(names), figsize=(6.4 * len(names), 10), sharex=True, sharey=True,
        squeeze=False, layout="constrained",
    )  # fmt: skip
    for row, rate_hz in enumerate(RATES_HZ):
        for column, loop in enumerate(names):
            axis = axes[row][column]
            draw_panel(axis, samples, loop, rate_hz)
            axis.set_title(f"{loop}, {rate_hz:,} messages/s")
            if row == len(RATES_HZ) - 1:
                axis.set_xlabel("publish → callback, milliseconds")
            if column == 0:
                axis.set_ylabel("share of messages that took longer")
    lines, labels = axes[0][0].get_legend_handles_labels()
    figure.legend(lines, labels, loc="outside lower center", ncols=len(labels))
    figure.suptitle("From publish to callback in one process, against a bare asyncio.Queue hop")
    figure.savefig(path, dpi=110)


def draw_panel(axis: Any, samples: Samples, loop: str, rate_hz: int) -> None:
    """Draw one line for each payload, and the guidance."""
    for key, values in samples.items():
        if key[:2] != (loop, rate_hz):
            continue
        ordered = np.sort(values) / 1e6
        longer = 1 - np.arange(len(ordered)) / len(ordered)
        bare = key[2] == QUEUE
        axis.step(
            ordered, longer, where="post", label=key[2], linewidth=2.4 if bare else 1.4,
            color="0.55" if bare else None, linestyle="--" if bare else "-",
        )  # fmt: skip
    axis.axvline(GUIDANCE_NS / 1e6, color="crimson", linewidth=1.5)
    axis.annotate(
        "10 ms", (GUIDANCE_NS / 1e6, 1), xytext=(-4, -4), textcoords="offset points", ha="right",
        va="top", color="crimson",
    )  # fmt: skip
    axis.set_xscale("log")
    axis.set_yscale("log")
    axis.set_xlim(0.003, 30)
    axis.set_ylim(1e-4, 1.3)
    axis.xaxis.set_major_formatter("{x:g}")
    axis.set_yticks([1, 0.1, 0.01, 1e-3, 1e-4])
    axis.set_yticklabels(["all", "1 in 10", "1 in 100", "1 in 1,000", "1 in 10,000"])
    axis.grid(which="major", alpha=0.3)


def main() -> None:
    """Measure, print, and write JSON and picture."""
    parser = argparse.ArgumentParser(description="Latency and throughput in one process.")
    parser.add_argument("--quick", action="store_true", help="a tenth of the time, rough figures")
    parser.add_argument("--results", type=Path, default=RESULTS, help="folder to write to")
    options = parser.parse_args()
    scale = 10 if options.quick else 1

    samples: Samples = {}
    throughputs: list[Throughput] = []
    for name, make_loop in loops().items():
        with asyncio.Runner(loop_factory=make_loop) as runner:
            runner.run(measure_latency(name, SECONDS / scale, samples))
            throughputs += runner.run(measure_throughput(name, THROUGHPUT_MESSAGES // scale))

    latencies = summarized(samples)
    print_tables(latencies, throughputs)
    options.results.mkdir(parents=True, exist_ok=True)
    result = {
        "environment": environment(),
        "latency": [asdict(row) for row in latencies],
        "throughput": [asdict(row) for row in throughputs],
    }
    json_path = options.results / "latency.json"
    json_path.write_text(json.dumps(result, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
    draw(samples, options.results / "latency.png")
    print(f"\nWritten: {json_path} and latency.png beside it")


if __name__ == "__main__":
    main()
