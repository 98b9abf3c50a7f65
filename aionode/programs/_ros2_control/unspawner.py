"""``controller_manager unspawner``: deactivates and unloads controllers."""

from __future__ import annotations

import argparse
import sys

import aionode
from aionode import Node
from aionode.arguments import remove_ros_args
from aionode.errors import CommandError
from aionode.interfaces.controller_manager_msgs import srv
from aionode.programs._ros2_control.client import ManagerClient, manager_name

__all__ = ["main", "unspawn"]


async def unspawn(manager: str, names: list[str], timeout_sec: float) -> None:
    """Deactivate and unload controllers.

    Raises:
        CommandError: One cannot be unloaded.
    """
    async with Node(f"unspawner_{names[0]}") as node:
        client = ManagerClient(node, manager_name(node, manager))
        # Controllers that are not active are unloaded all the same.
        if await client.switch(start=[], stop=names, asap=True, timeout_sec=timeout_sec):
            node.get_logger().info("Deactivated controller")
        for name in names:
            answer = await client.call(
                srv.UnloadController, "unload_controller", srv.UnloadController.Request(name=name)
            )
            if not answer.ok:
                raise CommandError(
                    f"Failed to unload controller {name}; the log of {client.manager} says why"
                )
            node.get_logger().info("Unloaded controller")


def main() -> None:
    """Unload the controllers that the arguments name."""
    parser = argparse.ArgumentParser(prog="unspawner")
    parser.add_argument("controller_names", nargs="+", help="names of controllers")
    parser.add_argument("-c", "--controller-manager", default="/controller_manager")
    parser.add_argument("--switch-timeout", type=float, default=5.0)
    given = parser.parse_args(remove_ros_args(sys.argv)[1:])
    aionode.run(
        lambda: unspawn(given.controller_manager, given.controller_names, given.switch_timeout)
    )
