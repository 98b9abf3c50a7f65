"""How many goals per second an action handles between two processes, and with 1000 kept goals.

One process serves `/fibonacci`; the other sends goals one after another, each with five feedback
messages and a result. The server keeps all results, as it does for 10 s by default, so the status
messages of the second figure list 1000 goals. The same is measured with rclpy, whose server and
client run on its default executor, and with its unmodified program on ``aionode run``. All take
turns, with new processes each time, so that other load on the machine affects all of them.

``CPU`` is the processor time of both processes per goal, which is useful on a shared machine.

rclpy is that of the interpreter named by ``AIONODE_BENCH_RCLPY``, or else of this one
(``pip install 'aionode[ros]'``). Run it with ``python benchmarks/actions.py``; it takes about half
a minute.
"""

from __future__ import annotations

import argparse
import asyncio
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any, Final

KEPT: Final = 1000
GOALS: Final = 200  # of one figure
WARM: Final = 20
FEEDBACKS: Final = 5
OURS, SHIM, THEIRS = "aionode", "rclpy's program on aionode run", "rclpy, default executor"
RCLPY_PROGRAM: Final = """
import os, sys, threading, time
import rclpy
try:
    from example_interfaces.action import Fibonacci
except ImportError:
    from test_msgs.action import Fibonacci
from rclpy.action import ActionClient, ActionServer
from rclpy.task import Future

role = sys.argv[1]
rclpy.init(args=[])
node = rclpy.create_node("bench_" + role)


def execute(handle):
    feedback = Fibonacci.Feedback(sequence=[0, 1, 1, 2])
    for _ in range(handle.request.order):
        handle.publish_feedback(feedback)
    handle.succeed()
    return Fibonacci.Result(sequence=[0, 1, 1, 2])


def wait(future):
    rclpy.spin_until_future_complete(node, future)
    return future.result()


if role == "server":
    ActionServer(node, Fibonacci, "fibonacci", execute, result_timeout=900)
    print('"ready"', flush=True)
    threading.Thread(target=lambda: (sys.stdin.read(), os._exit(0)), daemon=True).start()
    rclpy.spin(node)
client = ActionClient(node, Fibonacci, "fibonacci")
client.wait_for_server()
time.sleep(1.0)
print('"ready"', flush=True)
for line in sys.stdin:
    count, heard, began = int(line), [], time.perf_counter()
    for _ in range(count):
        goal = wait(client.send_goal_async(Fibonacci.Goal(order=5), heard.append))
        wait(goal.get_result_async())
    print(time.perf_counter() - began, flush=True)
os._exit(0)
"""


async def serve() -> None:
    """Run aionode's server until it is killed."""
    from aionode import ActionServer, Node
    from aionode.interfaces.example_interfaces.action import Fibonacci

    async def execute(goal: Any) -> Fibonacci.Result:
        feedback = Fibonacci.Feedback(sequence=[0, 1, 1, 2])
        for _ in range(goal.request.order):
            goal.publish_feedback(feedback)
        goal.succeed()
        return Fibonacci.Result(sequence=[0, 1, 1, 2])

    async with Node("bench_server") as node:
        ActionServer(node, Fibonacci, "fibonacci", execute, result_timeout=900)
        print('"ready"', flush=True)
        await asyncio.Event().wait()


async def send() -> None:
    """Send goals with aionode's client; each line of stdin gives their number."""
    from aionode import ActionClient, Node
    from aionode.interfaces.example_interfaces.action import Fibonacci

    async with Node("bench_client") as node:
        client = ActionClient(node, Fibonacci, "fibonacci")
        await client.wait_for_server()
        await asyncio.sleep(1.0)
        print('"ready"', flush=True)
        while line := await asyncio.to_thread(sys.stdin.readline):
            heard: list[Any] = []

            def hear(message: Any, heard: list[Any] = heard) -> None:
                heard.append(message)

            began = time.perf_counter()
            for _ in range(int(line)):
                goal = await client.send_goal(Fibonacci.Goal(order=FEEDBACKS), hear)
                await goal.result()
            print(time.perf_counter() - began, flush=True)


class Station:
    """One process of one candidate."""

    def __init__(self, command: list[str], role: str, domain_id: int) -> None:
        environment = {
            **os.environ,
            "ROS_DOMAIN_ID": str(domain_id),
            "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST",
        }
        self._process = subprocess.Popen(  # noqa: S603  # a program of this file
            [*command, role],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
            env=environment,
        )
        self.answer()

    def answer(self) -> Any:
        """Return the next line."""
        assert self._process.stdout is not None  # noqa: S101  # a pipe
        return json.loads(self._process.stdout.readline())

    def ask(self, count: int) -> float:
        """Send a number of goals, and return how many seconds they took."""
        assert self._process.stdin is not None  # noqa: S101  # a pipe
        self._process.stdin.write(f"{count}\n")
        self._process.stdin.flush()
        return float(self.answer())

    def used_s(self) -> float:
        """Return the processor time of all its threads."""
        tasks = Path(f"/proc/{self._process.pid}/task")
        return sum(int((one / "schedstat").read_text().split()[0]) for one in tasks.iterdir()) / 1e9

    def end(self) -> None:
        """End it."""
        self._process.kill()
        self._process.wait()


def measure(command: list[str], domain_id: int) -> dict[str, float]:
    """Return the figures of one turn of a candidate."""
    stations = [Station(command, "server", domain_id)]
    try:
        stations.append(Station(command, "client", domain_id))
        client = stations[1]
        client.ask(WARM)
        found: dict[str, float] = {}
        for name, before in (("first", 0), ("kept", KEPT - GOALS - WARM)):
            if before:
                client.ask(before)
            used = sum(each.used_s() for each in stations)
            found[f"{name}, goals/s"] = GOALS / client.ask(GOALS)
            now = sum(each.used_s() for each in stations)
            found[f"{name}, CPU ms"] = (now - used) / GOALS * 1e3
        return found
    finally:
        for each in stations:
            each.end()


def main() -> None:
    """Measure, and print a table."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--turns", type=int, default=3)
    parser.add_argument("role", nargs="?", help=argparse.SUPPRESS)
    args = parser.parse_args()
    if args.role:
        asyncio.run(serve() if args.role == "server" else send())
        return
    theirs = os.environ.get("AIONODE_BENCH_RCLPY", sys.executable)
    has_rclpy = not subprocess.run(  # noqa: S603  # named by the user
        [theirs, "-c", "import rclpy.action"], check=False, capture_output=True
    ).returncode
    with tempfile.TemporaryDirectory() as folder:
        program = Path(folder, "program.py")
        program.write_text(RCLPY_PROGRAM, encoding="utf-8")
        commands = {
            OURS: [sys.executable, __file__],
            SHIM: [sys.executable, "-m", "aionode", "run", str(program)],
        }
        if has_rclpy:
            commands[THEIRS] = [theirs, str(program)]
        turns: dict[str, list[dict[str, float]]] = {name: [] for name in commands}
        for _ in range(args.turns):
            for domain_id, (name, command) in enumerate(commands.items(), 70):
                turns[name].append(measure(command, domain_id))
    columns = list(turns[OURS][0])
    print(f"{'':32}" + "".join(f"{column:>16}" for column in columns))
    for name, found in turns.items():
        medians = [statistics.median(each[column] for each in found) for column in columns]
        print(f"{name:32}" + "".join(f"{median:>16.2f}" for median in medians))
    if not has_rclpy:
        print("skipped: rclpy is not installed; on Linux x86-64: pip install 'aionode[ros]'")


if __name__ == "__main__":
    main()
