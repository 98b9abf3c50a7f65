"""``controller_manager hardware_spawner``: configures or activates hardware components."""

from __future__ import annotations

import argparse
import sys

import aionode
from aionode import Node
from aionode.arguments import remove_ros_args
from aionode.interfaces.controller_manager_msgs import srv
from aionode.interfaces.lifecycle_msgs.msg import State
from aionode.programs._ros2_control.client import ManagerClient, manager_name

__all__ = ["main", "spawn_hardware"]


async def spawn_hardware(
    manager: str, names: list[str], wait_sec: float, *, is_activated: bool
) -> None:
    """Configure hardware components, or activate them too.

    Raises:
        CommandError: The manager does not answer.
    """
    action = "activate" if is_activated else "configure"
    target = (
        State(id=State.PRIMARY_STATE_ACTIVE, label="active")
        if is_activated
        else State(id=State.PRIMARY_STATE_INACTIVE, label="inactive")
    )
    async with Node("hardware_spawner") as node:
        client = ManagerClient(node, manager_name(node, manager), wait_sec=wait_sec)
        logger = node.get_logger()
        known = await client.call(
            srv.ListHardwareComponents,
            "list_hardware_components",
            srv.ListHardwareComponents.Request(),
        )
        for name in names:
            if name not in {each.name for each in known.component}:
                logger.warning("Hardware Component is not loaded - state can not be changed.")
                continue
            answer = await client.call(
                srv.SetHardwareComponentState,
                "set_hardware_component_state",
                srv.SetHardwareComponentState.Request(name=name, target_state=target),
            )
            state = answer.state.label
            if answer.ok and state == target.label:
                logger.info(f"{action}d component '{name}'. Hardware now in state: {state}.")
            else:
                logger.warning(f"Could not {action} component '{name}': it is {state or 'unknown'}")


def main() -> None:
    """Configure or activate the components that the arguments name."""
    parser = argparse.ArgumentParser(prog="hardware_spawner")
    action = parser.add_mutually_exclusive_group(required=True)
    action.add_argument("--activate", action="store_true", help="configure and activate them")
    action.add_argument("--configure", action="store_true", help="configure them")
    parser.add_argument("hardware_component_names", nargs="+")
    parser.add_argument("-c", "--controller-manager", default="controller_manager")
    parser.add_argument("--controller-manager-timeout", type=float, default=0.0)
    given = parser.parse_args(remove_ros_args(sys.argv)[1:])
    aionode.run(
        lambda: spawn_hardware(
            given.controller_manager,
            given.hardware_component_names,
            given.controller_manager_timeout,
            is_activated=given.activate,
        )
    )
