"""What a link between two processes of one host costs, compared with its lower bounds.

Everything goes from this process to another one and back, in slices that take turns, so that a
noisy minute hits all rows alike: as fast as it goes ("full rate"), and with a sleep of 10 ms before
each round trip ("100 Hz").

- Round trips of one small message: over a bare Unix socket in the same kind of loop, which is the
  floor; over zenoh-python with one `call_soon_threadsafe` for each message; over aionode with
  Zenoh; and over aionode with a link (`Node`, codec, callbacks and statistics included).
- Service calls: one coroutine that awaits `Client.call` again and again. Beside them a coroutine
  that awaits each answer of a bare Unix socket, as waking a coroutine has its price too.
- Images of 4 MB, all of whose data is read in place; a small message answers. Half of a small
  round trip taken off gives the time of one way. The floor copies 4 MB into memory that both
  processes have mapped, says so over a bare Unix socket, and reads it there with the same call.
- All this with each process on a core of its own, and the round trips and calls of small messages
  once more with both processes on one core. Left alone, the system chooses one or the other, and
  times differ by a factor of up to six: to wake another core takes time, above all in a virtual
  machine, while on one core neither process ever has to be woken from idleness.
- Bursts of 20 000 small messages into one callback; the rate is that of arrival.
- The processor time of a publisher with a timer of 100 Hz and of its reader: fresh processes that
  contain nothing else, over a link, over Zenoh, and as a bare timer and Unix socket.
- With rclpy, where `import rclpy` works: the round trip of a `std_msgs/String` between two further
  processes, each with rclpy's events executor and the middleware that is set up there. At full rate
  the callback publishes the next message; at 100 Hz the thread that spins sleeps in between.

The last table puts each target beside what was found. p50 is the median of the slices' medians,
p99 is of all round trips, and the first round trips of each slice do not count.

Run it with ``python benchmarks/ipc.py``; it takes up to six minutes, and ``--quick`` gives a
first look within a minute. It prints the tables and writes ``ipc.json`` to
``benchmarks/results/``.
"""

from __future__ import annotations

import argparse
import asyncio
import json
import os
import platform
import statistics
import subprocess
import sys
import tempfile
from collections.abc import Awaitable, Callable
from contextlib import AsyncExitStack, suppress
from importlib import metadata
from pathlib import Path
from typing import Any, Final

import zenoh

from aionode import Node
from aionode.interfaces.example_interfaces.srv import AddTwoInts

sys.path.insert(0, str(Path(__file__).parents[1]))  # run as a program, it finds its own parts

from benchmarks.ipc_parts.bursts import Burst, NodeBurst, SocketBurst
from benchmarks.ipc_parts.common import (
    AWAITED,
    CALL_LINK,
    CALL_ZENOH,
    FULL,
    IMAGE_FLOOR,
    IMAGE_LINK,
    IMAGE_ZENOH,
    ONE,
    OTHERS,
    OVER_LINK,
    OVER_ZENOH,
    PACED,
    PERIOD_S,
    QUICK,
    SETTLE,
    SMALL_OF,
    SOCKET,
    SPIN,
    ZENOH,
    Plan,
    Run,
    child,
    connect,
    is_linked,
    node_of,
    raw_session,
    shared_memory,
    zenoh_pair,
)
from benchmarks.ipc_parts.duty import duties, duty
from benchmarks.ipc_parts.echo import echo
from benchmarks.ipc_parts.rclpy_peer import has_rclpy, rclpy_ball, rclpy_process
from benchmarks.ipc_parts.round_trips import (
    Ball,
    Caller,
    ImageBall,
    MemoryBall,
    NodeBall,
    Player,
    SocketAsk,
    SocketBall,
)
from benchmarks.ipc_parts.tables import print_tables

RESULTS: Final = Path(__file__).parent / "results"


def row(what: str, speed: str, times: list[list[int]]) -> dict[str, Any]:
    """Return one line of the table, in microseconds: the median of the slices' medians."""
    everything = sorted(t for part in times for t in part)
    return {
        "what": what,
        "speed": speed,
        "p50_us": round(statistics.median(statistics.median(part) for part in times) / 1e3, 1),
        "p99_us": round(everything[len(everything) * 99 // 100] / 1e3, 1),
        "count": len(everything),
    }


async def in_turns(players: dict[str, Player], plan: Plan) -> list[dict[str, Any]]:
    """Return one line for each player and speed."""
    times: dict[tuple[str, str], list[list[int]]] = {}
    for _ in range(plan.rounds):
        for speed, count, pause_s in ((FULL, plan.full, 0.0), (PACED, plan.paced, PERIOD_S)):
            for name, player in players.items():
                fewer = 5 if name in SMALL_OF else 1
                found = await player.play(max(count // fewer, 4) + SETTLE[speed], pause_s)
                times.setdefault((speed, name), []).append(found[SETTLE[speed] :])
    return [row(name, speed, found) for (speed, name), found in times.items()]


def one_way(rows: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """Return the lines of the images again, less half of a small message's round trip."""
    small = {(one["what"], one["speed"]): one["p50_us"] / 2 for one in rows}
    return [
        one
        | {
            "what": f"{one['what']}, one way",
            "p50_us": round(one["p50_us"] - small[SMALL_OF[one["what"]], one["speed"]], 1),
            "p99_us": round(one["p99_us"] - small[SMALL_OF[one["what"]], one["speed"]], 1),
        }
        for one in rows
        if one["what"] in SMALL_OF
    ]


async def measure(place: Run, plan: Plan) -> dict[str, list[dict[str, Any]]]:
    """Return the tables of one loop."""
    async with AsyncExitStack() as stack:
        await stack.enter_async_context(child("echo", place))
        first = await stack.enter_async_context(
            node_of("ping", await stack.enter_async_context(place.context(0, link=False)))
        )
        second = await stack.enter_async_context(
            node_of("ping", await stack.enter_async_context(place.context(1, link=True)))
        )
        session = await asyncio.to_thread(raw_session, place.port, listen=False)
        stack.callback(session.close)
        buffer = shared_memory(place.folder)
        bare = Ball()
        bare.send = zenoh_pair(session, "raw/pong", "raw/ping", bare.back)
        small, large = (NodeBall(first), NodeBall(second)), (ImageBall(first), ImageBall(second))
        for ball in (*small, *large):
            await ball.publisher.wait_for_subscribers()
        asked = await connect(SocketAsk, place.folder, "raw")
        players: dict[str, Player] = {
            SOCKET: await connect(SocketBall, place.folder, "raw"),
            AWAITED: Caller(asked.ask),
            ZENOH: bare,
            OVER_ZENOH: small[0],
            OVER_LINK: small[1],
            CALL_ZENOH: await caller(first),
            CALL_LINK: await caller(second),
            **await rclpy_ball(place, stack),
            IMAGE_FLOOR: await connect(lambda: MemoryBall(buffer), place.folder, "image"),
            IMAGE_ZENOH: large[0],
            IMAGE_LINK: large[1],
        }
        for name, player in players.items():  # to warm up, and to hand over
            await player.play(20 if name in SMALL_OF else 300, 0)
        for ball in (small[1], large[1]):
            while not is_linked(ball.publisher):
                await ball.play(10, PERIOD_S)
        if place.cores_text == ONE:
            players = {name: player for name, player in players.items() if name not in SMALL_OF}
        rows = await in_turns(players, plan)
        bursts = []
        if place.cores_text != ONE:
            bursts = await burst_in_turns(place, session, (first, second), plan)
    return {
        "round_trips": [
            {"loop": place.loop, "cores": place.cores_text, **one} for one in rows + one_way(rows)
        ],
        "bursts": [{"loop": place.loop, **one} for one in bursts],
        "duties": [] if place.cores_text == ONE else await duties(place, plan),
    }


async def caller(node: Node) -> Caller:
    """Return a function that calls a service."""
    client = node.create_client(AddTwoInts, "add")
    await client.wait_for_service()
    return Caller(lambda: client.call(AddTwoInts.Request(a=1, b=2)))


async def burst_in_turns(
    place: Run, session: zenoh.Session, nodes: tuple[Node, Node], plan: Plan
) -> list[dict[str, Any]]:
    """Return how many messages a second arrive in one callback."""
    bare = Burst()
    bare.begin = zenoh_pair(session, "raw/burst", "raw/throw", bare.take)
    over_zenoh, over_link = (NodeBurst(node) for node in nodes)
    for node, thrower in zip(nodes, (over_zenoh, over_link), strict=True):
        await thrower.publisher.wait_for_subscribers()
        while node.count_publishers("burst") == 0:
            await node.graph.changed()
    bursts: dict[str, Burst] = {
        SOCKET: await connect(SocketBurst, place.folder, "throw"),
        ZENOH: bare,
        OVER_ZENOH: over_zenoh,
        OVER_LINK: over_link,
    }
    for turn in range(plan.bursts + 1):
        for burst in bursts.values():
            rate = await burst.play()
            if turn:  # the first one hands over
                burst.rates.append(rate)
    return [
        {
            "what": name,
            "messages_per_s": round(statistics.median(burst.rates)),
            "best_per_s": round(max(burst.rates)),
            "published_per_s": round(statistics.median(burst.sent)) if burst.sent else None,
            "lost": burst.lost,
        }
        for name, burst in bursts.items()
    ]


def loop_factory(name: str) -> Callable[[], asyncio.AbstractEventLoop] | None:
    """Return the factory of the event loop called `name`."""
    if name != "uvloop":
        return None
    import uvloop

    factory: Callable[[], asyncio.AbstractEventLoop] = uvloop.new_event_loop
    return factory


def run(loop: str, work: Awaitable[Any], limit_s: float | None = None) -> Any:
    """Run `work` on the loop called `loop`."""

    async def main() -> Any:
        async with asyncio.timeout(limit_s):
            return await work

    with asyncio.Runner(loop_factory=loop_factory(loop)) as runner:
        return runner.run(main())


def placements() -> list[tuple[int, ...]]:
    """Return where the two processes run: on one core each, on one, or anywhere if necessary."""
    if not hasattr(os, "sched_setaffinity"):
        return [()]
    cores = sorted(os.sched_getaffinity(0))
    return [(cores[0], cores[1]), (cores[0], cores[0])] if len(cores) > 1 else [()]


def part_of(args: argparse.Namespace) -> None:
    """Run the part of another process of this program."""
    cores = tuple(int(core) for core in args.cores.split(",") if core)
    if cores:  # before there are threads, which inherit it
        os.sched_setaffinity(0, {cores[args.part in OTHERS]})
    place = Run(args.folder, args.loop, args.port, cores)
    if args.part.startswith("rclpy"):
        rclpy_process(args.part)
    elif args.part == "measure":
        plan = QUICK if args.quick else Plan()
        print(json.dumps(run(args.loop, measure(place, plan), limit_s=300)))
    else:
        run(args.loop, echo(place) if args.part == "echo" else duty(args.part, args.kind, place))


def tables_of(args: argparse.Namespace, loop: str, cores: tuple[int, ...]) -> dict[str, list[Any]]:
    """Measure in a separate process, and return its tables."""
    buffer = "/dev/shm" if Path("/dev/shm").is_dir() else None  # noqa: S108  # memory, not a file
    with tempfile.TemporaryDirectory(dir=buffer) as folder:
        command = [
            sys.executable, __file__, "--part", "measure", "--folder", folder, "--loop", loop,
            "--port", str(args.port), "--cores", ",".join(map(str, cores)),
        ]  # fmt: skip
        if args.quick:
            command.append("--quick")
        output = subprocess.check_output(command)  # noqa: S603  # of this file
        tables: dict[str, list[Any]] = json.loads(output)
    return tables


def main() -> None:
    """Measure on both loops, print the tables and write the file."""
    assert __doc__ is not None  # noqa: S101  # -OO has no business here
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--quick", action="store_true", help="a first look within a minute")
    parser.add_argument("--loop", choices=["asyncio", "uvloop"], help="only this event loop")
    parser.add_argument(
        "--spin-us",
        default="",
        help="let the event loops spin so long before they block (all rows; only asyncio)",
    )
    for hidden in ("--part", "--folder", "--kind", "--cores"):
        parser.add_argument(hidden, default="", help=argparse.SUPPRESS)
    # Below the ports that the system assigns, and seldom those of a concurrent run.
    port = 18_600 + os.getpid() % 600 * 20
    parser.add_argument("--port", type=int, default=port, help=argparse.SUPPRESS)
    args = parser.parse_args()
    if args.part:
        with suppress(KeyboardInterrupt):
            part_of(args)
        return
    tables: dict[str, list[dict[str, Any]]] = {}
    if args.spin_us:
        args.loop = "asyncio"
        os.environ[SPIN] = args.spin_us
    for loop in [args.loop] if args.loop else ["asyncio", "uvloop"]:
        for cores in placements():
            for name, rows in tables_of(args, loop, cores).items():
                tables.setdefault(name, []).extend(rows)
    checked = print_tables(tables)
    if not has_rclpy():
        print("\nrclpy is not installed here, so it has no row.")
    RESULTS.mkdir(exist_ok=True)
    result = {
        "python": platform.python_version(),
        "machine": f"{platform.system()} {platform.machine()}, {os.cpu_count()} cores",
        "eclipse-zenoh": metadata.version("eclipse-zenoh"),
        **tables,
        "targets": checked,
    }
    (RESULTS / ("link_spinning.json" if args.spin_us else "ipc.json")).write_text(
        json.dumps(result, indent=1) + "\n"
    )


if __name__ == "__main__":
    main()
