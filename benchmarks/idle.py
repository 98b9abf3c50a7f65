"""What idle processes cost: processor time, wake-ups, threads and memory.

Each process has one node with one subscription, and receives nothing. They are measured alone,
beside busy programs of another domain, and while another process starts and ends, in their own
domain and in another one. Bare Zenoh sessions, connected like aionode's, and rclpy are measured for
comparison.

Run it with ``python benchmarks/idle.py``. It prints a table, writes ``idle.json`` and ``idle.png``
to ``benchmarks/results/``, and with ``--write docs/performance.md`` brings the page and the picture
beside it up to date. rclpy is imported by the Python that AIONODE_BENCH_RCLPY names.
"""

from __future__ import annotations

import argparse
import json
import os
import shutil
import statistics
import subprocess
import sys
import threading
import time
from collections import Counter
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from typing import Any, Final, NamedTuple

from roundtrip import machine  # type: ignore[import-not-found]  # beside this file when it is run

RESULTS: Final = Path(__file__).parent / "results"
CROWDS: Final = (3, 12, 20, 100)
BUSY: Final = (3, 20)
"""The number of idle processes beside busy ones of another domain."""
SETTLE_S: Final = 15.0
"""Time from the last start until the first measurement."""
SIGNS_S: Final = (50.0, 15.0)
"""The interval of aionode's signs of life to each other process, for the first process, and what is
added for each one that was there before."""
MAX_S: Final = 300.0
"""The longest time for which a crowd is looked at."""
STARTS: Final = 5
"""How many processes start and end while the others are measured."""
WINDOW_S: Final = 4.0
"""Time for a process to start and end, and for the others to finish reacting."""
BEGIN: Final = "<!-- idle.py: begin -->"
END: Final = "<!-- idle.py: end -->"

AIONODE: Final = """
import asyncio

import aionode
from aionode.interfaces.std_msgs.msg import String

async def main():
    async with aionode.Node("idle") as node:
        node.create_subscription(String, "nothing", lambda _: None, 10)
        print("ready", flush=True)  # the others know it: its start is not cut short
        await asyncio.Event().wait()

aionode.run(main)
"""

BUSY_ONE: Final = """
import aionode
from aionode.interfaces.std_msgs.msg import String

class Busy(aionode.Node):
    def __init__(self):
        super().__init__("busy")
        for number in range(20):
            self.create_subscription(String, f"busy_{number}", lambda _: None, 10)
        publisher = self.create_publisher(String, "busy_1", 10)
        self.create_timer(0.01, lambda: publisher.publish(String(data="hello")))
        print("ready", flush=True)

aionode.run(Busy)
"""

ZENOH: Final = """
import json, os, threading, zenoh
ports = json.loads(os.environ["IDLE_PORTS"])
config = zenoh.Config()
for key, value in {
    "mode": "peer",
    "listen/endpoints": [f"tcp/127.0.0.1:{ports[-1]}"],
    "connect/endpoints": [f"tcp/127.0.0.1:{port}" for port in ports[:-1]],
    "scouting/multicast/enabled": False,
    "scouting/gossip/enabled": False,
    "timestamping/enabled": False,
}.items():
    config.insert_json5(key, json.dumps(value))
session = zenoh.open(config)
token = session.liveliness().declare_token(f"idle/{ports[-1]}")
tokens = session.liveliness().declare_subscriber("idle/**", lambda _: None, history=True)
subscriber = session.declare_subscriber("nothing", lambda _: None)
print("ready", flush=True)
threading.Event().wait()
"""

RCLPY: Final = """
import rclpy
from std_msgs.msg import String

rclpy.init()
node = rclpy.create_node("idle")
subscription = node.create_subscription(String, "nothing", lambda _: None, 10)
print("ready", flush=True)
rclpy.spin_until_future_complete(node, rclpy.Future(), timeout_sec=100_000)
"""

PROGRAMS: Final = {"aionode": AIONODE, "bare Zenoh": ZENOH, "rclpy": RCLPY}


class Look(NamedTuple):
    """The system's counters of processes at one moment, summed up.

    Attributes:
        run_ns: Processor time of their threads.
        wakes: How often threads waited, by the threads' names.
    """

    run_ns: int
    wakes: Counter[str]


class Row(NamedTuple):
    """The cost of one process of a crowd.

    Attributes:
        core: Share of a core, in percent.
        wakes: Wake-ups a second.
        threads: Number of threads.
        mb: Resident memory, in MB.
        by_thread: Wake-ups a second, by the threads' names.
    """

    core: float
    wakes: float
    threads: float
    mb: float
    by_thread: dict[str, float]


def look(pids: list[int]) -> Look:
    """Read processor time and wake-ups of processes."""
    run_ns, wakes = 0, Counter[str]()
    for pid in pids:
        for task in Path(f"/proc/{pid}/task").iterdir():
            with suppress(OSError):  # it has ended
                run_ns += int((task / "schedstat").read_text().split()[0])
                lines = dict(
                    line.split(":\t", 1) for line in (task / "status").read_text().splitlines()
                )
                wakes[lines["Name"]] += int(lines["voluntary_ctxt_switches"])
    return Look(run_ns, wakes)


def start(peer: str, domain_id: int, ports: list[int], program: str = "") -> subprocess.Popen[str]:
    """Start a process."""
    python = os.environ.get("AIONODE_BENCH_RCLPY", sys.executable)
    env = {
        **os.environ,
        "ROS_DOMAIN_ID": str(domain_id),
        "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST",
        "IDLE_PORTS": json.dumps(ports),
    }
    process = subprocess.Popen(  # noqa: S603  # one of the programs above
        [python if peer == "rclpy" else sys.executable, "-c", program or PROGRAMS[peer]],
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
        env=env,
    )
    assert process.stdout is not None  # noqa: S101  # it is a pipe
    if process.stdout.readline().strip() != "ready":
        stop([process])
        raise RuntimeError(f"{peer}: it does not start")
    return process


def stop(processes: list[subprocess.Popen[str]]) -> None:
    """End processes."""
    for process in processes:
        process.terminate()
    for process in processes:
        try:
            process.wait(10)
        except subprocess.TimeoutExpired:
            process.kill()


@contextmanager
def crowd(peer: str, count: int, domain_id: int) -> Iterator[list[int]]:
    """Run idle processes of a peer; yield their ids."""
    processes: list[subprocess.Popen[str]] = []
    try:
        for number in range(count):
            ports = [20_000 + each for each in range(number + 1)]
            processes.append(start(peer, domain_id, ports))
        time.sleep(SETTLE_S)
        yield [process.pid for process in processes]
    finally:
        stop(processes)


@contextmanager
def busy(domain_id: int) -> Iterator[None]:
    """Run busy programs of a domain: three communicate, another keeps starting and ending."""
    done = threading.Event()

    def churn() -> None:
        while not done.is_set():
            stop([start("aionode", domain_id, [], BUSY_ONE)])

    talkers = [start("aionode", domain_id, [], BUSY_ONE) for _ in range(3)]
    churning = threading.Thread(target=churn)
    churning.start()
    try:
        yield
    finally:
        done.set()
        churning.join()
        stop(talkers)


def measured(pids: list[int], seconds: float) -> Row:
    """Measure processes for some time."""
    before, began = look(pids), time.monotonic()
    time.sleep(seconds)
    after, took_s = look(pids), time.monotonic() - began
    by_thread = {
        name: round(count / took_s / len(pids), 2)
        for name, count in (after.wakes - before.wakes).most_common(8)
    }
    status = [Path(f"/proc/{pid}/status").read_text() for pid in pids]
    value = {
        name: [int(text.split(f"{name}:")[1].split()[0]) for text in status]
        for name in ("Threads", "VmRSS")
    }
    return Row(
        core=(after.run_ns - before.run_ns) / 1e7 / took_s / len(pids),
        wakes=(after.wakes - before.wakes).total() / took_s / len(pids),
        threads=statistics.mean(value["Threads"]),
        mb=statistics.mean(value["VmRSS"]) / 1024,
        by_thread=by_thread,
    )


def period_s(peer: str, count: int, seconds: float) -> float:
    """Return how long to look at a crowd: each process gives a sign of life at least once."""
    first, each = SIGNS_S
    return max(seconds, min(first + each * count, MAX_S)) if peer == "aionode" else seconds


def prices_ms(peer: str, pids: list[int], domains: dict[str, int]) -> dict[str, float]:
    """Return what starting and ending a process costs each of a crowd, in ms of processor time.

    Periods in which one starts in each of the domains, and in which none does, take turns.
    """
    spent: dict[str, list[float]] = {name: [] for name in ("", *domains)}
    for number in range(STARTS):
        for name, times in spent.items():
            before, ends = look(pids), time.monotonic() + WINDOW_S
            if name:
                there = range(20_000, 20_000 + len(pids)) if domains[name] == OWN else ()
                stop([start(peer, domains[name], [*there, 21_000 + number])])
            time.sleep(max(ends - time.monotonic(), 0.0))
            times.append((look(pids).run_ns - before.run_ns) / 1e6 / len(pids))
    idle = statistics.median(spent.pop(""))
    return {name: round(statistics.median(times) - idle, 2) for name, times in spent.items()}


OWN: Final = 31
OTHER: Final = 32


def available() -> list[str]:
    """Return the peers that can be run here."""
    found = []
    for peer in PROGRAMS:
        with suppress(RuntimeError):
            stop([start(peer, OWN, [20_000])])
            found.append(peer)
    return found


def table(rows: dict[str, dict[str, Row]]) -> list[str]:
    """Return the table of the page."""
    lines = [
        "| idle processes | peer | processor | wake-ups a second | threads | memory |",
        "| --- | --- | ---: | ---: | ---: | ---: |",
    ]
    for what, peers in rows.items():
        for peer, row in peers.items():
            lines.append(
                f"| {what} | {peer} | {row.core:.3f} % | {row.wakes:.1f} | {row.threads:.0f} "
                f"| {row.mb:.0f} MB |"
            )
    return lines


def draw(rows: dict[str, dict[str, Row]], path: Path) -> None:
    """Plot processor time and wake-ups over the number of processes."""
    import matplotlib as mpl

    mpl.use("Agg")
    from matplotlib import pyplot as plt

    figure, axes = plt.subplots(1, 2, figsize=(10, 4))
    counts = [what for what in rows if what.isdigit()]
    for axis, field, title in zip(
        axes, ("core", "wakes"), ("% of a core", "wake-ups a second"), strict=True
    ):
        for peer in dict.fromkeys(peer for what in counts for peer in rows[what]):
            known = [what for what in counts if peer in rows[what]]
            axis.plot(
                [int(what) for what in known],
                [getattr(rows[what][peer], field) for what in known],
                marker="o",
                label=peer,
            )
        axis.set_xlabel("idle processes of one domain")
        axis.set_ylabel(f"{title}, each")
        axis.set_ylim(bottom=0)
        axis.grid(alpha=0.3)
    axes[0].legend()
    figure.tight_layout()
    figure.savefig(path, dpi=110)


def main() -> None:
    """Measure, print the table and write the files."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true", help="3 and 12 processes, for 5 s each")
    parser.add_argument(
        "--seconds", type=float, default=50.0, help="how long each is looked at, at least"
    )
    parser.add_argument("--peers", nargs="*", help="only these")
    parser.add_argument("--write", type=Path, metavar="PAGE", help="bring a page up to date")
    args = parser.parse_args()
    seconds = 5.0 if args.quick else args.seconds
    for name in ("AIONODE_MEETING_PORTS", "ROS_STATIC_PEERS"):
        os.environ.pop(name, None)
    peers = [peer for peer in available() if not args.peers or peer in args.peers]
    rows: dict[str, dict[str, Row]] = {}
    prices: dict[str, dict[str, float]] = {}
    for count in CROWDS[:2] if args.quick else CROWDS:
        for peer in peers:
            with crowd(peer, count, OWN) as pids:
                look_s = seconds if args.quick else period_s(peer, count, seconds)
                idle = rows.setdefault(str(count), {})[peer] = measured(pids, look_s)
                print(count, peer, idle, flush=True)
                if count == CROWDS[1]:
                    prices[peer] = prices_ms(peer, pids, {"other domain": OTHER, "own domain": OWN})
                    print(prices[peer], flush=True)
    for count in BUSY[:1] if args.quick else BUSY:
        for peer in peers:
            if peer != "bare Zenoh":
                with ExitStack() as stack:
                    pids = stack.enter_context(crowd(peer, count, OWN))
                    stack.enter_context(busy(OTHER))
                    what = f"{count} beside a busy other domain"
                    rows.setdefault(what, {})[peer] = measured(pids, seconds)
                    print(what, peer, rows[what][peer], flush=True)
    lines = table(rows)
    lines += [
        "",
        "| peer | a start in the own domain | in another domain |",
        "| --- | ---: | ---: |",
    ]
    for peer, price in prices.items():
        cells = [
            f"{max(price[key], 0.0):.1f} ms" if key in price else ""
            for key in ("own domain", "other domain")
        ]
        lines.append(f"| {peer} | {' | '.join(cells)} |")
    print("\n".join(lines))
    RESULTS.mkdir(exist_ok=True)
    record: dict[str, Any] = {
        **machine(),
        "seconds": seconds,
        "rows": {
            what: {peer: row._asdict() for peer, row in each.items()} for what, each in rows.items()
        },
        "start_ms": prices,
    }
    (RESULTS / "idle.json").write_text(json.dumps(record, indent=1) + "\n")
    draw(rows, RESULTS / "idle.png")
    if args.write:
        before, _, rest = args.write.read_text().partition(BEGIN)
        text = "\n".join(lines)
        args.write.write_text(f"{before}{BEGIN}\n{text}\n{END}{rest.split(END)[1]}")
        shutil.copy(RESULTS / "idle.png", args.write.parent / "idle.png")


if __name__ == "__main__":
    main()
