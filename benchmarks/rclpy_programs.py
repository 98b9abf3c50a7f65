"""The same rclpy programs on aionode and on ROS 2's rclpy: what a message takes.

One program publishes to a callback of its own node a hundred times a second (``in process``); two
programs send a small message to and fro a hundred times a second (``two processes``). A third one
ends as soon as its node has spun once (``start``). Each runs
unmodified on ``aionode run`` and on rclpy with its default and its events executor, side by side
and measured in turns, so that other load affects all of them.

rclpy is that of the interpreter named by ``RCLPY_PYTHON``, or else of this one
(``pip install 'aionode[ros]'``). Run it with ``python benchmarks/rclpy_programs.py``.
"""

from __future__ import annotations

import argparse
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

PROGRAM = """
import json, os, sys, threading, time
import rclpy
from rclpy.task import Future
from std_msgs.msg import String

role, kind = sys.argv[1:3]
rclpy.init(args=[])
if kind == "events":
    from rclpy.experimental.events_executor import EventsExecutor as Executor
else:
    from rclpy.executors import SingleThreadedExecutor as Executor
node = rclpy.create_node(f"{role}_{kind}")
executor = Executor()
executor.add_node(node)
if role == "start":
    executor.spin_once(timeout_sec=0)
    os._exit(0)
there, back = ("same", "same") if role == "alone" else ("ping", "pong")
if role == "echo":
    pongs = node.create_publisher(String, back, 10)
    node.create_subscription(String, there, pongs.publish, 10)
    threading.Thread(target=lambda: (sys.stdin.read(), os._exit(0)), daemon=True).start()
    executor.spin_until_future_complete(Future(), timeout_sec=600.0)
    sys.exit()
pings = node.create_publisher(String, there, 10)
times, began, done = [], 0, Future()


def returned(message):
    times.append(time.perf_counter_ns() - began)
    done.set_result(None)


node.create_subscription(String, back, returned, 10)
while not (pings.get_subscription_count() and node.count_publishers(back)):
    time.sleep(0.05)
time.sleep(1.0)
for line in sys.stdin:
    times.clear()
    for _ in range(int(line)):
        time.sleep(0.01)
        done, message = Future(), String(data="x" * 23)
        began = time.perf_counter_ns()
        pings.publish(message)
        executor.spin_until_future_complete(done, timeout_sec=5.0)
    print(json.dumps(times), flush=True)
os._exit(0)
"""

MESSAGES = 50  # of one turn
OURS, DEFAULT, EVENTS = "aionode run", "rclpy, default executor", "rclpy, events executor"
PROCESSOR = ", processor"
AIMS = (
    ("start", DEFAULT, 1.0),
    ("in process", DEFAULT, 0.25),
    ("in process" + PROCESSOR, EVENTS, 0.7),
    ("two processes", EVENTS, 0.5),
    ("two processes" + PROCESSOR, EVENTS, 0.7),
)

Medians = dict[tuple[str, str], float]
"""Nanoseconds by row and candidate."""


def main() -> None:
    """Measure, and print a table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--turns", type=int, default=12, help="of half a second each")
    turns = parser.parse_args().turns
    theirs = os.environ.get("RCLPY_PYTHON", sys.executable)
    if subprocess.run([theirs, "-c", "import rclpy"], check=False, capture_output=True).returncode:  # noqa: S603  # named by the user
        print("skipped: rclpy is not installed; on Linux x86-64: pip install 'aionode[ros]'")
        return
    with tempfile.TemporaryDirectory() as folder:
        program = Path(folder, "program.py")
        program.write_text(PROGRAM, encoding="utf-8")
        ours = [sys.executable, "-m", "aionode", "run", str(program)]
        commands = {
            OURS: (*ours, "default"),
            DEFAULT: (theirs, str(program), "default"),
            EVENTS: (theirs, str(program), "events"),
        }
        medians = measure_start(commands, turns)
        for what, roles in (("in process", ("alone",)), ("two processes", ("echo", "player"))):
            medians |= measure(what, commands, roles, turns)
    print(f"{'medians in µs':24}" + "".join(f"{name:>26}" for name in commands))
    for what, base, aim in AIMS:
        row = "".join(f"{medians[what, name] / 1e3:>26.0f}" for name in commands)
        ratio = medians[what, OURS] / medians[what, base]
        print(f"{what:24}{row}   {ratio:.2f} x {base}'s (aim {aim})")


def measure(
    what: str, commands: dict[str, tuple[str, ...]], roles: tuple[str, ...], turns: int
) -> Medians:
    """Return how long a message takes, and the processor time of all programs for it.

    Args:
        what: The name of the row.
        commands: The candidates.
        roles: The programs of each.
        turns: Number of turns.
    """
    running = {
        name: [start(command, role, domain_id) for role in roles]
        for domain_id, (name, command) in enumerate(commands.items(), 60)
    }
    times: dict[str, list[int]] = {name: [] for name in commands}
    processor: dict[str, list[float]] = {name: [] for name in commands}
    try:
        for turn in range(turns + 1):
            for name, programs in running.items():
                before = sum(map(processor_ns, programs))
                found = ask(programs[-1])
                if turn:  # the first one is for warming up
                    times[name] += found
                    processor[name].append((sum(map(processor_ns, programs)) - before) / MESSAGES)
    finally:
        for programs in running.values():
            for each in programs:
                each.kill()
                each.wait()
    return {(what, name): statistics.median(times[name]) for name in commands} | {
        (what + PROCESSOR, name): statistics.median(processor[name]) for name in commands
    }


def processor_ns(program: subprocess.Popen[str]) -> int:
    """Return the processor time that the threads of a program have taken."""
    threads = Path(f"/proc/{program.pid}/task").glob("*/schedstat")
    return sum(int(thread.read_text().split()[0]) for thread in threads)


def measure_start(commands: dict[str, tuple[str, ...]], turns: int) -> Medians:
    """Return the median time of each candidate from its start until it has spun once, in ns."""
    times: dict[str, list[int]] = {name: [] for name in commands}
    for turn in range(turns + 1):
        for name, command in commands.items():
            began = time.perf_counter_ns()
            start(command, "start", 60).communicate()
            if turn:  # the first one fills caches
                times[name].append(time.perf_counter_ns() - began)
    return {("start", name): statistics.median(found) for name, found in times.items()}


def start(command: tuple[str, ...], role: str, domain_id: int) -> subprocess.Popen[str]:
    """Start one program in its own domain."""
    *program, kind = command
    environment = {
        **os.environ,
        "ROS_DOMAIN_ID": str(domain_id),
        "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST",
    }
    return subprocess.Popen(  # noqa: S603  # the program above
        [*program, role, kind],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
        env=environment,
    )


def ask(player: subprocess.Popen[str]) -> list[int]:
    """Return the times of one turn in nanoseconds."""
    if player.stdin is None or player.stdout is None:
        raise RuntimeError("the program has no pipes")
    player.stdin.write(f"{MESSAGES}\n")
    player.stdin.flush()
    line = player.stdout.readline()
    if not line:
        raise RuntimeError(f"{player.args!r} ended")
    found: list[int] = json.loads(line)
    time.sleep(0.02)  # work that is left over from the turn
    return found


if __name__ == "__main__":
    main()
