"""Forks while its node runs, and prints whether both processes go on. Its argument says how."""

from __future__ import annotations

import asyncio
import gc
import multiprocessing
import os
import subprocess
import sys
import warnings
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor

from aionode.engine.context import Context
from aionode.errors import AionodeError
from aionode.interfaces.std_msgs.msg import Int32
from aionode.node import Node
from tests.support.peers import quiet_node

FORK = multiprocessing.get_context("fork")
CHILD_S = 10.0

warnings.simplefilter("ignore", DeprecationWarning)  # of a fork beside threads


def tell(*words: object) -> None:
    """Print a line at once."""
    print(*words, flush=True)  # noqa: T201  # read by the test


async def run(node: Node) -> None:
    """Let a node run for a moment."""
    async with node:
        await node.get_clock().sleep(0.01)


def attempt(action: Callable[[], object]) -> None:
    """Print the result of an attempt."""
    try:
        action()
    except AionodeError as error:
        tell("child:", type(error).__name__, error)
    else:
        tell("child: done")


async def in_child(action: Callable[[], object]) -> None:
    """Run an action in a forked child, and print how it ended."""
    child = FORK.Process(target=attempt, args=(action,))
    child.start()
    await asyncio.to_thread(child.join, CHILD_S)
    tell("exit", child.exitcode)
    if child.exitcode is None:
        child.kill()


def square(number: int) -> int:
    """Compute something."""
    return number * number


async def fork(how: str, node: Node) -> None:
    """Fork as the argument says."""
    publisher = node.create_publisher(Int32, "other", 10)
    actions: dict[str, Callable[[], object]] = {
        "nothing": gc.collect,
        "a node": lambda: asyncio.run(run(quiet_node("child", Context.default()))),
        "its context": lambda: quiet_node("child", node.context),
        "a context": lambda: asyncio.run(run(quiet_node("child", Context()))),
        "local": lambda: asyncio.run(run(quiet_node("child", Context(transport="local")))),
        "publish": lambda: publisher.publish(Int32(data=1)),
        "destroy": node.destroy_node,
    }
    if how in actions:
        await in_child(actions[how])
    elif how == "pool":
        with ProcessPoolExecutor(2, mp_context=FORK) as executor:
            loop = asyncio.get_running_loop()
            squares = [loop.run_in_executor(executor, square, n) for n in range(4)]
            tell("squares", *await asyncio.gather(*squares))
    else:
        done = await asyncio.to_thread(
            lambda: subprocess.run(
                [sys.executable, "-c", "print(1)"],
                preexec_fn=lambda: None,
                timeout=CHILD_S,
                check=False,
            )
        )
        tell("exit", done.returncode)


async def main(how: str) -> None:
    """Fork, and continue."""
    async with asyncio.timeout(20), quiet_node("n", Context(link=True)) as node:
        with Context.as_default(node.context):
            other = quiet_node("other", Context(link=True))
            async with other:
                subscription = other.create_subscription(Int32, "numbers", None, 10)
                publisher = node.create_publisher(Int32, "numbers", 10)
                await publisher.wait_for_subscribers()
                for number in range(100):  # until the link has them
                    publisher.publish(Int32(data=number))
                    await subscription.receive()
                await fork(how, node)
                for number in range(100):
                    publisher.publish(Int32(data=number))
                    assert (await subscription.receive()).data == number
                folder = os.path.join(os.environ["XDG_RUNTIME_DIR"], "aionode")  # noqa: PTH118
                tell("sockets", len(os.listdir(folder)))  # noqa: PTH208
    tell("parent: done")


def between_loops() -> None:
    """Fork where no loop runs, with an open context; the child ends as programs do."""
    runner = asyncio.Runner()
    node = quiet_node("n", Context(link=True))
    runner.run(node.__aenter__())
    child = os.fork()
    if child == 0:
        gc.collect()
        sys.exit(0)
    _, status = os.waitpid(child, 0)
    tell("exit", os.waitstatus_to_exitcode(status))
    runner.run(node.__aexit__(None, None, None))
    runner.close()
    tell("parent: done")


if __name__ == "__main__":
    if sys.argv[1] == "between":
        between_loops()
    else:
        asyncio.run(main(sys.argv[1]))
