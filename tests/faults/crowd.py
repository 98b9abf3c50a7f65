"""Nodes come and go beside ``aionode router``, which has to answer newcomers all the while.

``make crowd``, or ``python -m tests.faults.crowd --nodes 300 --seconds 120``: a few processes make
and end nodes, each in a context of its own, with a publisher, a subscription and all that a node
has. Four times a second a newcomer opens a plain Zenoh session with the router, asks it for all
tokens, and leaves. Another one does the same with a second router that is alone: what is slow there
as well is the machine. The program fails if one newcomer gets no answer, or if 99 % of them take
`LIMIT_S` longer with the first router than with the second.
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
from contextlib import ExitStack, closing, contextmanager
from typing import Final

import zenoh  # plays the newcomer, without aionode

from aionode import Context, Node
from aionode.interfaces.std_msgs.msg import String
from tests.support.peers import free_ports, isolated_environment, zenoh_config

LIMIT_S: Final = 0.05
"""How much later than the idle router the other one may have answered 99 % of the newcomers."""

ANSWER_S: Final = 5.0
"""Time after which a newcomer counts as unanswered, in seconds."""

PERIOD_S: Final = 0.25
PROCESSES: Final = 3
SIDE_BY_SIDE: Final = 2
"""How many nodes of each process are there at once."""


async def come_and_go(name: str, count: int, each_s: float) -> None:
    """Make and end so many nodes, one after the other."""
    for number in range(count):
        async with Context() as context, Node(f"{name}_{number}", context=context) as node:
            publisher = node.create_publisher(String, "crowd", 10)
            node.create_subscription(String, "crowd", lambda _: None, 10)
            publisher.publish(String(data=name))
            await asyncio.sleep(each_s)


async def be_a_crowd(name: str, count: int, seconds: float) -> None:
    """Make and end `count` nodes in `seconds`, some side by side."""
    each = -(-count // SIDE_BY_SIDE)
    async with asyncio.TaskGroup() as tasks:
        for number in range(SIDE_BY_SIDE):
            tasks.create_task(come_and_go(f"{name}_{number}", each, seconds / each * 0.7))


def newcomer_s(port: int) -> float:
    """Return how long the router at a port takes to take a newcomer and tell it all tokens."""
    config = zenoh_config(
        {
            "mode": "client",
            "connect/endpoints": [f"tcp/127.0.0.1:{port}"],
            "scouting/multicast/enabled": False,
        }
    )
    began = time.perf_counter()
    with closing(zenoh.open(config)) as session:
        for reply in session.liveliness().get("**", timeout=ANSWER_S):
            if reply.ok is None:
                raise TimeoutError(f"no answer in {ANSWER_S} s")
        return time.perf_counter() - began


def most_s(times_s: list[float]) -> float:
    """Return the time in which 99 % have an answer."""
    return statistics.quantiles(times_s, n=100, method="inclusive")[98]


@contextmanager
def routers(*ports: int) -> Iterator[None]:
    """Run a router at each port."""
    with ExitStack() as stack:
        for port in ports:
            listen = f"tcp/127.0.0.1:{port}"
            program = [sys.executable, "-m", "aionode", "router", "--listen", listen]
            router = stack.enter_context(subprocess.Popen(program, stdout=subprocess.PIPE))
            stack.callback(router.terminate)
            assert router.stdout is not None
            router.stdout.readline()
        yield


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
    crowd_s, idle_s = [], []
    with ExitStack() as stack:
        stack.enter_context(routers(port, idle_port))
        newcomer_s(port), newcomer_s(idle_port)  # what is made once for all
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
            crowd_s.append(newcomer_s(port))
            idle_s.append(newcomer_s(idle_port))
            time.sleep(PERIOD_S)
        took_s = time.monotonic() - began
        failed = [each.returncode for each in crowd if each.returncode]
    late_s = most_s(crowd_s) - most_s(idle_s)
    for what, times in (("beside the crowd", crowd_s), ("idle", idle_s)):
        print(  # noqa: T201 - a program
            f"{what}: {len(times)} newcomers, median {1e3 * statistics.median(times):.1f} ms, "
            f"99 % {1e3 * most_s(times):.1f} ms, "
            f"longest {1e3 * max(times):.1f} ms"
        )
    print(  # noqa: T201 - a program
        f"{options.nodes} nodes in {took_s:.0f} s; load {os.getloadavg()[0]:.0f}"
    )
    sys.exit(f"ended with {failed}" if failed else late_s > LIMIT_S)


if __name__ == "__main__":
    main()
