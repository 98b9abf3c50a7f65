"""ROS 2's client of a managed talker: takes `lifecycle_talker.py` through its whole life.

``--ros-args -p pause:=3.0`` waits for so many seconds in each state.
"""

import aionode
from aionode import Node
from aionode.errors import TransitionError
from aionode.lifecycle import LifecycleManager

STEPS = (
    "configure",
    "activate",
    "deactivate",
    "activate",
    "deactivate",
    "cleanup",
    "configure",
    "activate",
    "shutdown",
)


async def manage() -> None:
    """Request one transition after another, and print the state of the talker after each."""
    async with Node("lc_client") as node:
        pause_s = node.declare_parameter("pause", 1.0).value
        manager = LifecycleManager(node, ["/lc_talker"])
        for label in STEPS:
            await manager.change_state("/lc_talker", label)
            state = await manager.get_state("/lc_talker")
            node.get_logger().info(f"Node lc_talker has current state {state}.")
            await node.get_clock().sleep(pause_s)
        try:
            await manager.change_state("/lc_talker", "activate")
        except TransitionError as error:
            node.get_logger().info(f"As expected: {error}")


if __name__ == "__main__":
    aionode.run(manage)
