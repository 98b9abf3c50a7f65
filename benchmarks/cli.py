"""How long commands take from the shell's point of view, and whether their rates are right.

Commands are timed alone, and ``aionode topic list`` also beside 20 processes, all of whose topics
it has to list. Given ``--before`` with a checkout of another commit, its commands take turns with
these; the aim is three quarters of its time, or 120 ms for ``aionode topic list``.
``topic hz`` is compared with the publisher's own count.

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

HERE: Final = Path(__file__).parents[1]
RESULTS: Final = Path(__file__).parent / "results"
AIONODE: Final = [sys.executable, "-m", "aionode"]
COMMANDS: Final = ("--help", "topic list", "topic --help", "param list")
AIM: Final = 0.75  # of the time before
TOPIC_LIST_MS: Final = 120
BESIDE: Final = 20
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

BYSTANDER: Final = """
import sys, aionode
from aionode.interfaces.std_msgs.msg import String

class Bystander(aionode.Node):
    def __init__(self):
        super().__init__("bystander" + sys.argv[1])
        self.create_publisher(String, "/beside" + sys.argv[1], 10)
        print("ready", flush=True)

aionode.run(Bystander)
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


def start_times(
    env: dict[str, str], commands: tuple[str, ...], before: Path | None, rounds: int
) -> list[dict[str, Any]]:
    """Return how long each command takes, from its start to its end, in milliseconds.

    Raises:
        RuntimeError: `aionode topic list` leaves out a topic of a bystander.
    """
    checkouts = {"now": HERE} | ({} if before is None else {"before": before.resolve()})
    rows = []
    for words in commands:
        taken: dict[str, list[float]] = {name: [] for name in checkouts}
        for turn in range(rounds + 1):
            for name, checkout in checkouts.items():
                began = time.perf_counter()
                answer = subprocess.run(  # noqa: S603  # our own program
                    [*AIONODE, *words.split()],
                    env=env | {"PYTHONPATH": str(checkout)},
                    cwd="/",  # the current folder would come before the checkout
                    check=True,
                    stdout=subprocess.PIPE,
                    text=True,
                ).stdout
                if turn:  # the first one compiles
                    taken[name].append((time.perf_counter() - began) * 1e3)
                known = sum(line.startswith("/beside") for line in answer.splitlines())
                if words == "topic list" and known != int(env.get("BESIDE", 0)):
                    raise RuntimeError(f"{name}: {known} topics are listed of {env['BESIDE']}")
        beside = f", beside {env['BESIDE']}" if "BESIDE" in env else ""
        medians = {name: statistics.median(times) for name, times in taken.items()}
        rows.append({"command": words + beside, "medians_ms": medians})
        text = f"aionode {words + beside:22} {medians['now']:5.0f} ms"
        text += f", max {max(taken['now']):.0f} ms"
        if before is not None:
            ratio = medians["now"] / medians["before"]
            text += f", {ratio:.2f} x before ({medians['before']:.0f} ms; aim {AIM}"
            text += f" or {TOPIC_LIST_MS} ms)" if words == "topic list" else ")"
        print(text)
    return rows


def beside_others(env: dict[str, str], before: Path | None, rounds: int) -> list[dict[str, Any]]:
    """Return how long `aionode topic list` takes beside other processes."""
    others = [
        subprocess.Popen(  # noqa: S603  # our own program
            [sys.executable, "-c", BYSTANDER, str(number)],
            env=env,
            stdout=subprocess.PIPE,
            text=True,
        )
        for number in range(BESIDE)
    ]
    try:
        for each in others:
            assert each.stdout is not None  # noqa: S101  # it has a pipe
            each.stdout.readline()
        time.sleep(5.0)  # until they have found each other
        return start_times(env | {"BESIDE": str(BESIDE)}, ("topic list",), before, rounds)
    finally:
        for each in others:
            each.kill()
            each.wait()


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
    parser.add_argument("--before", type=Path, help="checkout of another commit, to compare with")
    args = parser.parse_args()
    quick, before = args.quick, args.before
    env = quiet_environment()
    rounds = 3 if quick else 15
    results = {
        "machine": platform.platform(),
        "cpus": os.cpu_count(),
        "python": platform.python_version(),
        "versions": {name: metadata.version(name) for name in ("aionode", "click", "msgspec")},
        "start": start_times(env, COMMANDS, before, rounds) + beside_others(env, before, rounds),
        "hz": rates(env, 5 if quick else 12),
    }
    RESULTS.mkdir(exist_ok=True)
    (RESULTS / "cli.json").write_text(f"{json.dumps(results, indent=2)}\n", encoding="utf-8")


if __name__ == "__main__":
    main()
