"""The whole rover in one process: ``python -m aionode.examples.rover``.

With ``--ros-args -p use_sim_time:=true -p rate:=5.0`` it uses simulated time from /clock, which
runs five times as fast as wall time.
"""

from __future__ import annotations

import argparse
import asyncio

import aionode
from aionode.examples.rover.battery import Battery
from aionode.examples.rover.description import Description
from aionode.examples.rover.driver import Driver
from aionode.examples.rover.simulator import Simulator

__all__ = ["main"]


async def main() -> None:
    """Run the rover and its page until Ctrl-C."""
    async with Simulator() as simulator, Description(), Battery(), Driver():
        try:
            from aionode.examples.rover import page
        except ModuleNotFoundError as missing:  # the text says what to install
            simulator.get_logger().warning(f"The rover has no page: {missing}")
            await asyncio.Event().wait()
        else:
            await page.main()


if __name__ == "__main__":
    # Arguments of ROS are left to `run`; this parser answers --help.
    argparse.ArgumentParser(
        prog="python -m aionode.examples.rover",
        description="A small robot in a world of its own, and a page to drive it.",
        epilog="--ros-args -p port:=8090 has the page at another port; "
        "--ros-args -p use_sim_time:=true -p rate:=5.0 runs it five times as fast as wall time.",
    ).parse_known_args()
    aionode.run(main)
