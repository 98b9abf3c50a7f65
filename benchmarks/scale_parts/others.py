"""Another process of `scale.py`: subscriptions, or nodes that count the nodes they know.

It reads commands from its standard input, one per line, and answers each with one line of JSON.
"""

from __future__ import annotations

import asyncio
import gc
import json
import os
import sys
import time
from contextlib import AsyncExitStack
from pathlib import Path
from typing import Any

from aionode import Context, Node
from aionode.interfaces.std_msgs.msg import String

EVERY = 10
"""Number of endpoints after which the event loop gets a turn."""


POLL_S = 0.1
"""Interval at which a process checks whether it has met all others."""


async def pause(number: int) -> None:
    """Let the event loop run now and then."""
    if number % EVERY == EVERY - 1:
        await asyncio.sleep(0)


async def meet(nodes: list[Node], wanted: int, wait_s: float) -> list[float]:
    """Wait until all nodes know a number of others, and are linked with all of them but themselves.

    This is done here rather than in the asking process, because a hundred processes that are asked
    repeatedly would be busy with that. Return what the least informed node has found, the CPU time,
    and when that was.
    """
    began = time.monotonic()
    while True:
        nodes_found, links = (min(counts) for counts in zip(*map(found, nodes), strict=True))
        now = time.monotonic()
        if (nodes_found >= wanted and links >= wanted - 1) or now > began + wait_s:
            return [nodes_found, links, time.process_time(), now]
        await asyncio.sleep(POLL_S)


async def know(node: Node, wanted: int, wait_s: float) -> int:
    """Wait until a node knows a number of the topics that processes have; return how many."""
    ends = time.monotonic() + wait_s
    while True:
        known = sum(name.startswith("/of_") for name, _ in node.get_topic_names_and_types())
        if known >= wanted or time.monotonic() > ends:
            return known
        await asyncio.sleep(POLL_S)


async def idle(seconds: float) -> dict[str, float]:
    """Return the share of a core that this process uses while idle, in percent, and its memory."""
    gc.collect()
    began = time.process_time()
    await asyncio.sleep(seconds)
    return {"core": 100 * (time.process_time() - began) / seconds, "kb": resident_kb()}


def resident_kb() -> float:
    """Return the memory of this process."""
    pages = int(Path("/proc/self/statm").read_text(encoding="ascii").split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 1000


def found(node: Node) -> list[int]:
    """Return how many nodes a node knows, and with how many contexts its own is linked."""
    by_link: Any = next(t for t in node.context.transports if hasattr(t, "manager"))
    return [len(node.get_node_names()), len(by_link.manager.links)]


async def serve(name: str, contexts: int, *, link: bool) -> None:
    """Execute the commands, in a number of contexts; endpoints are in the first one."""
    loop = asyncio.get_running_loop()
    async with AsyncExitStack() as stack:
        nodes = []
        for number in range(contexts):
            context = await stack.enter_async_context(Context(link=link))
            node = Node(f"{name}_{number}", context=context)
            nodes.append(await stack.enter_async_context(node))
        nodes[0].create_subscription(String, "warm_up", lambda _: None, 10)
        made: list[Any] = []
        say("ready")
        while words := (await loop.run_in_executor(None, sys.stdin.readline)).split():
            await change(words, nodes, made)
            say(await answer(words, nodes))


async def change(words: list[str], nodes: list[Node], made: list[Any]) -> None:
    """Create or destroy what a command says, if it is one for that."""
    node = nodes[0]
    match words:
        case ["make" | "crowd" as what, count]:
            for number in range(int(count)):
                topic = "crowd" if what == "crowd" else f"t{number}"
                made.append(node.create_subscription(String, topic, lambda _: None, 10))
                await pause(number)
        case ["destroy"]:
            for number, subscription in enumerate(made):
                subscription.destroy()
                await pause(number)
        case ["join"]:
            for each in nodes:
                made.append(each.create_publisher(String, "everyone", 10))
                made.append(each.create_subscription(String, "everyone", lambda _: None, 10))
        case ["topics", count, own, other]:
            for number in range(int(count)):
                topic = f"of_{other}/t{number}"
                made.append(node.create_publisher(String, f"of_{own}/t{number}", 10))
                made.append(node.create_subscription(String, topic, lambda _: None, 10))


async def answer(words: list[str], nodes: list[Node]) -> Any:
    """Return the answer to a command."""
    match words:
        case ["meet", wanted, wait_s]:
            return await meet(nodes, int(wanted), float(wait_s))
        case ["know", wanted, wait_s]:
            return await know(nodes[0], int(wanted), float(wait_s))
        case ["idle", seconds]:
            return await idle(float(seconds))
    return {"cpu_s": time.process_time(), "threads": threads()}


def threads() -> int:
    """Return how many threads this process has; those of Zenoh included, where that is known."""
    try:
        with open("/proc/self/status", encoding="ascii") as status:  # noqa: PTH123  # no file
            return next(int(line.split()[1]) for line in status if line.startswith("Threads"))
    except OSError:
        return 0


def raise_limit() -> None:
    """Raise the limit of descriptors as far as allowed: a context has two for each other one."""
    try:
        import resource
    except ImportError:  # Windows
        return
    _, most = resource.getrlimit(resource.RLIMIT_NOFILE)
    resource.setrlimit(resource.RLIMIT_NOFILE, (most, most))


def say(value: object) -> None:
    """Answer."""
    print(json.dumps(value), flush=True)


if __name__ == "__main__":
    raise_limit()
    asyncio.run(serve(sys.argv[1], int(sys.argv[3]), link=sys.argv[2] == "link"))
