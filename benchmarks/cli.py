"""How long commands take from the shell's point of view, and whether their rates are right.

``aionode --help`` should answer in 250 ms and ``aionode topic list`` in 600 ms, both without a
daemon that has everything ready. ``topic hz`` is compared with the publisher's own count.

Run it with ``python benchmarks/cli.py``. It prints a table and writes ``cli.json`` to
``benchmarks/results/``; ``--quick`` measures less.
"""

from __future__ import annotations

import argparse
import json
import os
import platform
import signal
import socket
import statistics
import subprocess
import sys
import time
from importlib import metadata
from pathlib import Path
from typing import Any, Final

RESULTS: Final = Path(__file__).parent / "results"
AIONODE: Final = [sys.executable, "-m", "aionode"]
TARGETS_MS: Final = {"--help": 250, "topic list": 600, "topic --help": None, "param list": None}
RATES_HZ: Final = {1_000: 0.01, 10_000: 0.05}

TALKER: Final = """
import sys, time, aionode
from aionode.interfaces.std_msgs.msg import String

class Talker(aionode.Node):
    def __init__(self):
        super().__init__("talker")
        self.message = String(data="x" * 20)
        self.publisher = self.create_publisher(String, "/fast", 10)
        self.create_timer(1 / float(sys.argv[1]), self.talk)
        self.create_timer(1.0, self.tell)
        self.began, self.sent = time.perf_counter(), 0

    def talk(self):
        self.publisher.publish(self.message)
        self.sent += 1

    def tell(self):
        now = time.perf_counter()
        print(self.sent / (now - self.began), flush=True)
        self.began, self.sent = now, 0

aionode.run(Talker)
"""


def quiet_environment() -> dict[str, str]:
    """Return variables that isolate a command from everything else on the machine."""
    made = [socket.socket() for _ in range(4)]
    for each in made:
        each.bind(("127.0.0.1", 0))
    ports = [str(each.getsockname()[1]) for each in made]
    for each in made:
        each.close()
    return os.environ | {
        "ROS_DOMAIN_ID": "43",
        "AIONODE_MEETING_PORTS": ",".join(ports[:3]),
        "AIONODE_ROUTER_PORT": ports[3],
    }


def start_times(env: dict[str, str], rounds: int) -> list[dict[str, Any]]:
    """Return how long each command takes, from its start to its end, in milliseconds."""
    rows = []
    for words, target in TARGETS_MS.items():
        taken = []
        for _ in range(rounds):
            began = time.perf_counter()
            subprocess.run(  # noqa: S603  # our own program
                [*AIONODE, *words.split()], env=env, check=True, stdout=subprocess.DEVNULL
            )
            taken.append((time.perf_counter() - began) * 1e3)
        row = {"command": words, "median_ms": statistics.median(taken), "max_ms": max(taken)}
        rows.append({**row, "target_ms": target})
        limit = "" if target is None else f"  (target {target} ms)"
        print(f"aionode {words:14} {row['median_ms']:7.0f} ms, max {row['max_ms']:.0f} ms{limit}")
    return rows


def rates(env: dict[str, str], seconds: int) -> list[dict[str, Any]]:
    """Return the rates that ``topic hz`` prints for fast topics, and the actual numbers."""
    rows = []
    for wanted, tolerance in RATES_HZ.items():
        talker = subprocess.Popen(  # noqa: S603  # our own program
            [sys.executable, "-c", TALKER, str(wanted)], env=env, stdout=subprocess.PIPE, text=True
        )
        watcher = subprocess.Popen(  # noqa: S603  # our own program
            [*AIONODE, "topic", "hz", "/fast", "--json", "-w", str(wanted)],
            env=env,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            text=True,
        )
        time.sleep(seconds)
        for process in (watcher, talker):
            process.send_signal(signal.SIGINT)
        said = [json.loads(line)["rate_hz"] for line in watcher.communicate()[0].splitlines()]
        true = [float(line) for line in talker.communicate()[0].splitlines()]
        # The first second of each includes its start.
        row = {
            "wanted_hz": wanted,
            "published_hz": statistics.mean(true[1:]),
            "said_hz": statistics.mean(said[1:]),
            "tolerance": tolerance,
        }
        row["error"] = row["said_hz"] / row["published_hz"] - 1
        rows.append(row)
        print(
            f"topic hz: {row['said_hz']:9.1f} Hz said, {row['published_hz']:9.1f} Hz published, "
            f"error {row['error']:+.2%} (tolerance {tolerance:.0%})"
        )
    return rows


def main() -> None:
    """Measure, print, and store the results."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="measure less")
    quick = parser.parse_args().quick
    env = quiet_environment()
    results = {
        "machine": platform.platform(),
        "cpus": os.cpu_count(),
        "python": platform.python_version(),
        "versions": {name: metadata.version(name) for name in ("aionode", "click", "msgspec")},
        "start": start_times(env, 3 if quick else 15),
        "hz": rates(env, 5 if quick else 12),
    }
    RESULTS.mkdir(exist_ok=True)
    (RESULTS / "cli.json").write_text(f"{json.dumps(results, indent=2)}\n", encoding="utf-8")


if __name__ == "__main__":
    main()
