"""How soon one process receives from another: from its exec to its first message.

The first process publishes a hundred times a second. The second is a whole program: it loads
Python, aionode and Zenoh, finds the first by itself and prints the first message that it receives.
In turns with it runs a bare program, which loads Zenoh, numpy and msgspec, opens a session that is
told the address of a publisher like the first, and prints the first sample. Given ``--before`` with
a checkout of another commit, the second process of that commit takes its turns as well.

Besides the time on the clock the table has the processor time of the process, which depends less on
what else the machine does.

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
import os, time
aionode.Node
print("imported", time.process_time(), flush=True)

class Second(aionode.Node):
    def __init__(self):
        super().__init__("second")
        self.create_subscription(String, "hello", self.hear, 10)

    def hear(self, msg):
        print("heard", time.process_time(), flush=True)
        os._exit(0)

aionode.run(Second)
"""

BARE_FIRST: Final = """
import time, zenoh
config = zenoh.Config()
config.insert_json5("scouting/multicast/enabled", "false")
config.insert_json5("listen/endpoints", '["tcp/127.0.0.1:18486"]')
session = zenoh.open(config)
publisher = session.declare_publisher("hello")
print("ready", flush=True)
while True:
    publisher.put(b"hello")
    time.sleep(0.01)
"""

BARE_SECOND: Final = """
import os, threading, time
import msgspec, numpy, zenoh
print("imported", time.process_time(), flush=True)
config = zenoh.Config()
config.insert_json5("mode", '"client"')
config.insert_json5("scouting/multicast/enabled", "false")
config.insert_json5("connect/endpoints", '["tcp/127.0.0.1:18486"]')
heard = threading.Event()
session = zenoh.open(config)
subscriber = session.declare_subscriber("hello", lambda sample: heard.set())
heard.wait()
print("heard", time.process_time(), flush=True)
os._exit(0)
"""


def start(program: str, checkout: Path | None = None) -> subprocess.Popen[str]:
    """Start a program, with aionode from a checkout if one is given."""
    environment = dict(os.environ)
    if checkout is not None:
        environment["PYTHONPATH"] = str(checkout)
    return subprocess.Popen(  # noqa: S603  # one of those above
        [sys.executable, "-c", program], stdout=subprocess.PIPE, text=True, env=environment
    )


def second_ms(program: str, checkout: Path | None = None) -> dict[str, float]:
    """Run a second process once: ms until its modules are loaded, and until it receives."""
    began_ns = time.perf_counter_ns()
    times = {}
    with start(program, checkout) as process:
        assert process.stdout is not None  # noqa: S101  # it is a pipe
        for line in process.stdout:
            step, processor_s = line.split()
            times[step] = (time.perf_counter_ns() - began_ns) / 1e6
            times[f"{step}, processor"] = float(processor_s) * 1e3
    return times


def main() -> None:
    """Measure, print the table and write the file."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true", help="a quarter of the runs")
    parser.add_argument("--before", type=Path, help="checkout of another commit, to compare with")
    args = parser.parse_args()
    os.environ["AIONODE_MEETING_PORTS"] = "18482,18483,18484"  # do not meet other processes
    os.environ["AIONODE_ROUTER_PORT"] = "18485"
    seconds = {"aionode": (SECOND, None), "bare": (BARE_SECOND, None)}
    if args.before is not None:
        seconds["before"] = (SECOND, args.before.resolve())
    runs: dict[str, list[dict[str, float]]] = {name: [] for name in seconds}
    with start(FIRST) as first, start(BARE_FIRST) as bare_first:
        for process in (first, bare_first):
            assert process.stdout is not None  # noqa: S101  # it is a pipe
            process.stdout.readline()
        for turn in range(1 + (RUNS // 4 if args.quick else RUNS)):
            for name, second in seconds.items():
                times = second_ms(*second)
                if turn:  # the first one is for warming up
                    runs[name].append(times)
        first.terminate()
        bare_first.terminate()
    rows = {
        f"{name}: {step}": {
            "p50_ms": round(statistics.median(times[step] for times in found), 1),
            "min_ms": round(min(times[step] for times in found), 1),
            "max_ms": round(max(times[step] for times in found), 1),
        }
        for name, found in runs.items()
        for step in found[0]
    }
    print(f"{'from exec until':30} {'p50':>7} {'min':>7} {'max':>7}   in ms; target {TARGET_MS}")
    for name, row in rows.items():
        print(f"{name:30} {row['p50_ms']:7} {row['min_ms']:7} {row['max_ms']:7}")
    for name in list(seconds)[1:]:
        ratios = (
            f"{step} {rows[f'aionode: {step}']['p50_ms'] / rows[f'{name}: {step}']['p50_ms']:.2f}"
            for step in ("heard", "heard, processor")
        )
        print(f"aionode's median, times that of {name}: {'; '.join(ratios)}")
    RESULTS.mkdir(exist_ok=True)
    result = {**machine(), "runs": len(runs["aionode"]), "rows": rows}
    (RESULTS / "start.json").write_text(json.dumps(result, indent=1) + "\n")


if __name__ == "__main__":
    main()
