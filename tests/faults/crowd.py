"""Nodes come and go at ``aionode router``, which has to answer newcomers all the time.

``make crowd``, or ``python -m tests.faults.crowd --nodes 300 --seconds 120``: a few processes
create and destroy nodes, each in a context of its own, with a publisher, a subscription and
everything else that a node has. Four times a second a newcomer opens a plain Zenoh session with the
router, queries all tokens, and leaves; another one does the same with a second, idle router.

On a busy machine, most of that time is spent waiting for a processor. Linux counts these waits for
each thread; the longest wait of a thread, in the router and in the newcomer, is subtracted. What is
left is what the router computes, and what it waits for by itself, such as a lock. The program fails
if a newcomer gets no answer, or if one takes `LIMIT_S` longer than the slowest one with the idle
router.
"""

from __future__ import annotations

import argparse
import asyncio
import os
import statistics
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import ExitStack, closing, contextmanager, suppress
from pathlib import Path
from typing import Final

import zenoh  # plays the newcomer, without aionode

from aionode import Context, Node
from aionode.interfaces.std_msgs.msg import String
from tests.support.peers import free_ports, isolated_environment, zenoh_config

LIMIT_S: Final = 0.05
"""How much later than the idle router the other one may answer, apart from waiting for a processor.
"""

ANSWER_S: Final = 5.0
"""Time after which a newcomer counts as unanswered, in seconds."""

PERIOD_S: Final = 0.25
PROCESSES: Final = 3
SIDE_BY_SIDE: Final = 2
"""Number of simultaneous nodes of each process."""


async def come_and_go(name: str, count: int, each_s: float) -> None:
    """Create and destroy a number of nodes, one after another."""
    for number in range(count):
        async with Context() as context, Node(f"{name}_{number}", context=context) as node:
            publisher = node.create_publisher(String, "crowd", 10)
            node.create_subscription(String, "crowd", lambda _: None, 10)
            publisher.publish(String(data=name))
            await asyncio.sleep(each_s)


async def be_a_crowd(name: str, count: int, seconds: float) -> None:
    """Create and destroy `count` nodes within `seconds`, some at the same time."""
    each = -(-count // SIDE_BY_SIDE)
    async with asyncio.TaskGroup() as tasks:
        for number in range(SIDE_BY_SIDE):
            tasks.create_task(come_and_go(f"{name}_{number}", each, seconds / each * 0.7))


def newcomer(port: int) -> None:
    """Connect to the router at a port, query all tokens, and disconnect.

    Raises:
        TimeoutError: the router does not answer.
    """
    config = zenoh_config(
        {
            "mode": "client",
            "connect/endpoints": [f"tcp/127.0.0.1:{port}"],
            "scouting/multicast/enabled": False,
        }
    )
    with closing(zenoh.open(config)) as session:
        for reply in session.liveliness().get("**", timeout=ANSWER_S):
            if reply.ok is None:
                raise TimeoutError(f"no answer in {ANSWER_S} s")


def scheduled_ns(process: int) -> dict[str, tuple[int, int]]:
    """Return how long each thread of a process has run and waited for a processor, by its id.

    Empty where the system does not report it.
    """
    found = {}
    for path in Path(f"/proc/{process}/task").glob("*/schedstat"):
        with suppress(OSError):  # a thread that has ended
            ran, waited, _ = map(int, path.read_text().split())
            found[path.parent.name] = ran, waited
    return found


class Scheduled:
    """Measures the threads of a process from now on."""

    def __init__(self, process: int) -> None:
        self._process = process
        self._before = scheduled_ns(process)

    def since_ns(self) -> tuple[int, int]:
        """Return the total time that all threads have run, and the longest wait of one.

        Threads wait at the same time, so the sum of their waits would be too much.
        """
        ran_ns, waits_ns = 0, [0]
        for thread, (ran, waited) in scheduled_ns(self._process).items():
            ran_before, waited_before = self._before.get(thread, (0, 0))
            ran_ns += ran - ran_before
            waits_ns.append(waited - waited_before)
        return ran_ns, max(waits_ns)


class Answers:
    """How long a router took to answer newcomers.

    Attributes:
        whole_s: The whole time, from the newcomer's first step on.
        own_s: The same, without waits for a processor.
        ran_s: How long the router has run meanwhile.
    """

    def __init__(self, port: int, router: int) -> None:
        self.port = port
        self.router = router
        self.whole_s: list[float] = []
        self.own_s: list[float] = []
        self.ran_s: list[float] = []

    def ask(self) -> None:
        """Let one newcomer query the router."""
        router, own = Scheduled(self.router), Scheduled(os.getpid())
        began_ns = time.perf_counter_ns()
        newcomer(self.port)
        took_ns = time.perf_counter_ns() - began_ns
        ran_ns, waited_ns = router.since_ns()
        waited_ns += own.since_ns()[1]
        self.whole_s.append(took_ns / 1e9)
        self.own_s.append(max(took_ns - waited_ns, 0) / 1e9)
        self.ran_s.append(ran_ns / 1e9)

    def text(self) -> str:
        """Return the figures, in milliseconds."""
        return (
            f"{len(self.whole_s)} newcomers; whole time {spread_text(self.whole_s)}; "
            f"without waiting for a processor {spread_text(self.own_s)}; "
            f"the router ran {spread_text(self.ran_s)}"
        )


def spread_text(times_s: list[float]) -> str:
    """Return the median, the 99th percentile and the maximum of some times."""
    most_s = statistics.quantiles(times_s, n=100, method="inclusive")[98]
    values = (statistics.median(times_s), most_s, max(times_s))
    return "{:.1f}, {:.1f}, {:.1f} ms".format(*(1e3 * each for each in values))


@contextmanager
def routers(*ports: int) -> Iterator[list[int]]:
    """Run a router at each port; yield their process ids."""
    processes = []
    with ExitStack() as stack:
        for port in ports:
            listen = f"tcp/127.0.0.1:{port}"
            program = [sys.executable, "-m", "aionode", "router", "--listen", listen]
            router = stack.enter_context(subprocess.Popen(program, stdout=subprocess.PIPE))
            stack.callback(router.terminate)
            assert router.stdout is not None
            router.stdout.readline()
            processes.append(router.pid)
        yield processes


def main() -> None:
    """Run the crowd and both newcomers, and print the results."""
    parser = argparse.ArgumentParser(description="Nodes come and go beside a router.")
    parser.add_argument("--nodes", type=int, default=300)
    parser.add_argument("--seconds", type=float, default=120.0)
    parser.add_argument("--crowd", help="be one of the processes, with nodes of this name")
    options = parser.parse_args()
    if options.crowd:
        asyncio.run(be_a_crowd(options.crowd, options.nodes, options.seconds))
        return
    variables = isolated_environment()
    (idle_port,) = free_ports(1)
    port = int(variables["AIONODE_ROUTER_PORT"])
    program = [sys.executable, "-m", "tests.faults.crowd", "--seconds", str(options.seconds)]
    program += ["--nodes", str(-(-options.nodes // PROCESSES)), "--crowd"]
    with ExitStack() as stack:
        busy_router, idle_router = stack.enter_context(routers(port, idle_port))
        busy, idle = Answers(port, busy_router), Answers(idle_port, idle_router)
        for each_port in (port, idle_port):
            newcomer(each_port)  # creates what all share
        began = time.monotonic()
        crowd = [
            stack.enter_context(
                subprocess.Popen([*program, f"p{number}"], env={**os.environ, **variables})
            )
            for number in range(PROCESSES)
        ]
        for each in crowd:
            stack.callback(each.kill)
        while any(each.poll() is None for each in crowd):
            busy.ask()
            idle.ask()
            time.sleep(PERIOD_S)
        took_s = time.monotonic() - began
        failed = [each.returncode for each in crowd if each.returncode]
    print("of each: median, 99 %, longest")  # noqa: T201 - a program
    for what, answers in (("beside the crowd", busy), ("idle", idle)):
        print(f"{what}: {answers.text()}")  # noqa: T201 - a program
    print(  # noqa: T201 - a program
        f"{options.nodes} nodes in {took_s:.0f} s; load {os.getloadavg()[0]:.0f}"
    )
    late = max(busy.own_s) - max(idle.own_s) > LIMIT_S
    sys.exit(f"ended with {failed}" if failed else late)


if __name__ == "__main__":
    main()
