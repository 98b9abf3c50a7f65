"""How soon one process receives from another: from its exec to its first message.

The first process publishes a hundred times a second. The second is a whole program: it loads
Python, aionode and Zenoh, finds the first by itself and prints the first message that it receives.

Run it with ``python benchmarks/start.py``. It prints a table and writes ``start.json`` to
``benchmarks/results/``.
"""

from __future__ import annotations

import argparse
import json
import os
import statistics
import subprocess
import sys
import time
from pathlib import Path
from typing import Final

from roundtrip import machine  # type: ignore[import-not-found]  # beside this file when it is run

RUNS: Final = 20
TARGET_MS: Final = 300
RESULTS: Final = Path(__file__).parent / "results"

FIRST: Final = """
import aionode
from aionode.interfaces.std_msgs.msg import String

class First(aionode.Node):
    def __init__(self):
        super().__init__("first")
        publisher = self.create_publisher(String, "hello", 10)
        self.create_timer(0.01, lambda: publisher.publish(String(data="hello")))
        print("ready", flush=True)

aionode.run(First)
"""

SECOND: Final = """
import aionode
from aionode.interfaces.std_msgs.msg import String
print("imported", flush=True)

class Second(aionode.Node):
    def __init__(self):
        super().__init__("second")
        self.create_subscription(String, "hello", self.hear, 10)

    def hear(self, msg):
        print("heard", flush=True)
        self.destroy_node()

aionode.run(Second)
"""


def start(program: str) -> subprocess.Popen[str]:
    """Start a program."""
    return subprocess.Popen(  # noqa: S603  # one of the two above
        [sys.executable, "-c", program], stdout=subprocess.PIPE, text=True
    )


def second_ms() -> tuple[float, float]:
    """Run the second process once: ms until its modules are loaded, and until it receives."""
    began_ns = time.perf_counter_ns()
    with start(SECOND) as process:
        assert process.stdout is not None  # noqa: S101  # it is a pipe
        times = [(time.perf_counter_ns() - began_ns) / 1e6 for _ in process.stdout]
    return times[0], times[1]


def main() -> None:
    """Measure, print the table and write the file."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true", help="a quarter of the runs")
    args = parser.parse_args()
    os.environ["AIONODE_MEETING_PORTS"] = "18482,18483,18484"  # do not meet other processes
    os.environ["AIONODE_ROUTER_PORT"] = "18485"
    with start(FIRST) as first:
        assert first.stdout is not None  # noqa: S101  # it is a pipe
        first.stdout.readline()
        second_ms()  # to warm up
        runs = [second_ms() for _ in range(RUNS // 4 if args.quick else RUNS)]
        first.terminate()
    rows = {
        name: {
            "p50_ms": round(statistics.median(times), 1),
            "min_ms": round(min(times), 1),
            "max_ms": round(max(times), 1),
        }
        for name, times in zip(("imported", "heard"), zip(*runs, strict=True), strict=True)
    }
    print(f"{'from exec until':16} {'p50':>7} {'min':>7} {'max':>7}   in ms; target {TARGET_MS}")
    for name, row in rows.items():
        print(f"{name:16} {row['p50_ms']:7} {row['min_ms']:7} {row['max_ms']:7}")
    RESULTS.mkdir(exist_ok=True)
    result = {**machine(), "runs": len(runs), "rows": rows}
    (RESULTS / "start.json").write_text(json.dumps(result, indent=1) + "\n")


if __name__ == "__main__":
    main()
