"""How soon one process receives from another: from its exec to its first message.

The first process publishes a hundred times a second. The second is a whole program: it loads
Python, aionode and Zenoh, finds the first by itself and prints the first message that it receives.
In turns with it runs a bare program, which loads Zenoh, numpy and msgspec, opens a session that is
told the address of a publisher like the first, and prints the first sample. Given ``--before`` with
a checkout of another commit, the second process of that commit takes its turns as well.

Besides the time on the clock the table has the processor time of the process, which depends less on
what else the machine does. The picture shows for both how they divide into steps: Python itself,
the modules of the program, its event loop, the node with the modules of the transports, Zenoh's
open with discovery, and the rest until the first message, which is the first link or match.

Run it with ``python benchmarks/start.py``. It prints a table, writes ``start.json`` and
``start.png`` to ``benchmarks/results/``, and with ``--write docs/performance.md`` brings the page
and the picture there up to date.
"""

from __future__ import annotations

import argparse
import json
import os
import shutil
import statistics
import subprocess
import sys
import time
from pathlib import Path
from typing import Final

from roundtrip import machine  # type: ignore[import-not-found]  # beside this file when it is run

RUNS: Final = 20
TARGET_MS: Final = 300
HERE: Final = Path(__file__).parents[1]
RESULTS: Final = Path(__file__).parent / "results"
BEGIN: Final = "<!-- start.py: begin -->"
END: Final = "<!-- start.py: end -->"

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

SAY: Final = """
import time

def say(step):
    print(step, time.perf_counter_ns(), time.process_time_ns(), flush=True)

say("started")
"""

SECOND: Final = (
    SAY
    + """
import aionode
from aionode.interfaces.std_msgs.msg import String
import os
aionode.Node
say("imported")

class Second(aionode.Node):
    def __init__(self):
        say("running")
        super().__init__("second")
        self.create_subscription(String, "hello", self.hear, 10)
        say("created")

    async def __aenter__(self):
        node = await super().__aenter__()
        say("opened")
        return node

    def hear(self, msg):
        say("heard")
        os._exit(0)

aionode.run(Second)
"""
)

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

BARE_SECOND: Final = (
    SAY
    + """
import os, threading
import msgspec, numpy, zenoh
say("imported")
config = zenoh.Config()
config.insert_json5("mode", '"client"')
config.insert_json5("scouting/multicast/enabled", "false")
config.insert_json5("connect/endpoints", '["tcp/127.0.0.1:18486"]')
heard = threading.Event()
session = zenoh.open(config)
say("opened")
subscriber = session.declare_subscriber("hello", lambda sample: heard.set())
heard.wait()
say("heard")
os._exit(0)
"""
)

STEPS: Final = {
    "started": "Python",
    "imported": "modules",
    "running": "event loop",
    "created": "transports' modules, node",
    "opened": "Zenoh's open, discovery",
    "heard": "first message",
}
"""What has been done at each step, for the picture; the bare program has no event loop and node."""


def start(program: str, checkout: Path | None = None) -> subprocess.Popen[str]:
    """Start a program, with aionode from a checkout if one is given."""
    environment = dict(os.environ)
    environment.pop("PYTHONDONTWRITEBYTECODE", None)  # compiled in the first turn
    return subprocess.Popen(  # noqa: S603  # one of those above
        [sys.executable, "-c", program],
        stdout=subprocess.PIPE,
        text=True,
        env=environment,
        cwd=HERE if checkout is None else checkout,  # where Python looks for modules first
    )


def second_ms(program: str, checkout: Path | None = None) -> dict[str, float]:
    """Run a second process once, and return the time until each step, in ms."""
    began_ns = time.perf_counter_ns()
    times = {}
    with start(program, checkout) as process:
        assert process.stdout is not None  # noqa: S101  # it is a pipe
        for line in process.stdout:
            step, reached_ns, processor_ns = line.split()
            times[step] = (int(reached_ns) - began_ns) / 1e6
            times[f"{step}, processor"] = int(processor_ns) / 1e6
    return times


def table(rows: dict[str, dict[str, float]]) -> list[str]:
    """Return the table of the page."""
    lines = ["| | on the clock | processor time |", "| --- | ---: | ---: |"]
    for name in dict.fromkeys(key.split(": ")[0] for key in rows):
        for step, what in (("imported", "modules loaded"), ("heard", "first message")):
            clock, processor = (
                rows[f"{name}: {step}{suffix}"]["p50_ms"] for suffix in ("", ", processor")
            )
            who = f"*{name} program, {what}*" if name == "bare" else f"{name}, {what}"
            lines.append(f"| {who} | {clock:.0f} ms | {processor:.0f} ms |")
    return lines


def draw(rows: dict[str, dict[str, float]], path: Path) -> None:
    """Draw how the time of each program divides into steps."""
    import matplotlib as mpl

    mpl.use("Agg")
    from matplotlib import pyplot as plt

    figure, axes = plt.subplots(1, 2, figsize=(10, 3), sharey=True)
    names = list(dict.fromkeys(key.split(": ")[0] for key in rows))[::-1]
    for axis, suffix, title in zip(
        axes, ("", ", processor"), ("ms on the clock", "ms of processor time"), strict=True
    ):
        ends = dict.fromkeys(names, 0.0)
        for step, what in STEPS.items():
            reached = {
                name: rows.get(f"{name}: {step}{suffix}", {"p50_ms": ends[name]})["p50_ms"]
                for name in names
            }
            widths = [max(reached[name] - ends[name], 0.0) for name in names]
            axis.barh(names, widths, left=[ends[name] for name in names], label=what)
            ends = reached
        axis.set_xlabel(title)
    figure.legend(*axes[0].get_legend_handles_labels(), loc="upper center", ncols=3)
    figure.tight_layout(rect=(0, 0, 1, 0.84))
    figure.savefig(path, dpi=110)


def main() -> None:
    """Measure, print the table and write the file."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true", help="a quarter of the runs")
    parser.add_argument("--before", type=Path, help="checkout of another commit, to compare with")
    parser.add_argument("--write", type=Path, metavar="PAGE", help="bring a page up to date")
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
    draw(rows, RESULTS / "start.png")
    if args.write is not None:
        before, _, rest = args.write.read_text().partition(BEGIN)
        text = "\n".join(table(rows))
        args.write.write_text(f"{before}{BEGIN}\n{text}\n{END}{rest.split(END)[1]}")
        shutil.copy(RESULTS / "start.png", args.write.parent / "start.png")


if __name__ == "__main__":
    main()
