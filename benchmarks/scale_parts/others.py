"""One other process of `scale.py`: subscriptions, or a node that counts the nodes it knows.

It reads commands from its standard input, one a line, and answers each with one line of JSON.
"""

from __future__ import annotations

import asyncio
import json
import sys
import time
from typing import Any

from aionode import Context, Node
from aionode.interfaces.std_msgs.msg import String

EVERY = 10
"""Number of endpoints after which the event loop gets a turn."""


async def pause(number: int) -> None:
    """Let the event loop run now and then."""
    if number % EVERY == EVERY - 1:
        await asyncio.sleep(0)


async def serve(name: str, *, link: bool) -> None:
    """Do what the commands say."""
    loop = asyncio.get_running_loop()
    async with Context(link=link) as context, Node(name, context=context) as node:
        node.create_subscription(String, "warm_up", lambda _: None, 10)
        made: list[Any] = []
        say("ready")
        while words := (await loop.run_in_executor(None, sys.stdin.readline)).split():
            if words[0] == "make":
                for number in range(int(words[1])):
                    made.append(node.create_subscription(String, f"t{number}", lambda _: None, 10))
                    await pause(number)
            elif words[0] == "destroy":
                for number, subscription in enumerate(made):
                    subscription.destroy()
                    await pause(number)
            elif words[0] == "join":
                made.append(node.create_publisher(String, "everyone", 10))
                made.append(node.create_subscription(String, "everyone", lambda _: None, 10))
            if words[0] == "found":
                by_link: Any = next(t for t in context.transports if hasattr(t, "manager"))
                say([len(node.get_node_names()), len(by_link.manager.links)])
            else:
                say({"cpu_s": time.process_time(), "threads": threads()})


def threads() -> int:
    """Return how many threads this process has; those of Zenoh included, where that is known."""
    try:
        with open("/proc/self/status", encoding="ascii") as status:  # noqa: PTH123  # no file
            return next(int(line.split()[1]) for line in status if line.startswith("Threads"))
    except OSError:
        return 0


def say(value: object) -> None:
    """Answer."""
    print(json.dumps(value), flush=True)


if __name__ == "__main__":
    asyncio.run(serve(sys.argv[1], link=sys.argv[2] == "link"))
