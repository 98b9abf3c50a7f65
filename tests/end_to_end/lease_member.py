"""A robot for tests whose commander holds a lease.

``python tests/end_to_end/lease_member.py commander TTL WHAT`` publishes 1.0 on /speed every 20 ms
in a lease of TTL seconds, with the stop 0.0, and prints ``driving``. With ``hold`` as a further
argument it publishes 0, 1, 2 ..., each of which is its own stop. After a line on stdin, it does
WHAT: ``sleep`` and ``spin`` block its event loop for 2 s, ``fork`` ends the lease in a forked
child, ``orphan`` ends the loop without ending the block, ``hang`` blocks the loop forever. Then it
prints ``blocked``. It prints the name of the error that ends the block, and does not end.
``… wheels`` prints ``speed VALUE`` for each message on /speed.
"""

from __future__ import annotations

import asyncio
import os
import sys
import threading

import aionode
from aionode import CommandLease, Context, Node
from aionode.clock import perf_ns
from aionode.errors import AionodeError
from aionode.interfaces.std_msgs.msg import Float64

STEP_SEC = 0.02
BLOCK_SEC = 2.0


def tell(*words: object) -> None:
    """Write one line at once."""
    sys.stdout.write(" ".join(str(word) for word in words) + "\n")
    sys.stdout.flush()


class Wheels(Node):
    """Prints its commands."""

    def __init__(self) -> None:
        super().__init__("wheels")
        self.create_subscription(Float64, "/speed", lambda msg: tell("speed", msg.data))


def block(what: str) -> None:
    """Block the event loop."""
    if what == "spin":
        ends_ns = perf_ns() + int(BLOCK_SEC * 1e9)
        while perf_ns() < ends_ns:
            pass
    else:
        threading.Event().wait(60 if what == "hang" else BLOCK_SEC)


async def drive(lease: CommandLease[Float64], what: str, *, holds: bool) -> None:
    """Publish commands, and do `what` after a line on stdin."""
    line = threading.Thread(target=sys.stdin.readline, daemon=True)
    line.start()
    for count in range(10_000):
        command = Float64(data=count if holds else 1.0)
        lease.publish(command, stop=command if holds else None)
        if count == 10:
            tell("driving")
        if not line.is_alive() and what:
            if what == "fork":
                fork(lease)
                tell("sent")
            elif what == "orphan":
                asyncio.get_running_loop().stop()
            else:
                tell("blocked")
                block(what)
            what = ""
        await asyncio.sleep(STEP_SEC)  # noqa: TID251  # real time


def fork(lease: CommandLease[Float64]) -> None:
    """Fork a child, which prints what it is allowed to do."""
    child = os.fork()
    if child:
        os.waitpid(child, 0)
        return
    try:
        lease.publish(Float64(data=2.0))
    except AionodeError as error:
        tell("child", type(error).__name__)
    leaving = lease.__aexit__(None, None, None)
    try:
        leaving.send(None)
    except StopIteration:
        tell("child", "left")
    os._exit(0)


async def command(ttl_sec: float, what: str, *, holds: bool = False) -> None:
    """Hold the lease."""
    async with Node("commander") as node:
        speed = node.create_publisher(Float64, "/speed", 10)
        await speed.wait_for_subscribers()
        try:
            stop = None if holds else Float64(data=0.0)
            async with speed.lease(stop=stop, ttl_sec=ttl_sec) as lease:
                await drive(lease, what, holds=holds)
        except AionodeError as error:
            tell(type(error).__name__)
            await asyncio.Event().wait()


def orphan(ttl_sec: float, what: str) -> None:
    """Leave the end of the block, and everything else, to the end of the process."""
    loop = asyncio.new_event_loop()
    task = loop.create_task(command(ttl_sec, what))
    loop.run_forever()
    tell("orphaned", task.done())
    loop.close()
    threading.Event().wait(BLOCK_SEC)


def main(role: str, ttl_sec: str = "", what: str = "", stop: str = "") -> None:
    """Run one program."""
    os.environ.setdefault("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
    Context.default()
    if role == "wheels":
        aionode.run(Wheels, args=[])
    elif what == "orphan":
        orphan(float(ttl_sec), what)
    else:
        aionode.run(lambda: command(float(ttl_sec), what, holds=stop == "hold"), args=[])


if __name__ == "__main__":
    main(*sys.argv[1:])
