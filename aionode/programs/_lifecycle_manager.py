"""``nav2_lifecycle_manager``: brings managed nodes up in order, and down if one of them is lost."""

from __future__ import annotations

from collections.abc import Awaitable
from typing import Any, Final

import aionode
from aionode import DurabilityPolicy, Node, Parameter, QoSProfile, Timer
from aionode.errors import AionodeError, CommandError
from aionode.interfaces.diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from aionode.interfaces.lifecycle_msgs.srv import ChangeState
from aionode.interfaces.nav2_msgs.srv import ManageLifecycleNodes
from aionode.interfaces.std_msgs.msg import Bool
from aionode.interfaces.std_srvs.srv import Trigger
from aionode.lifecycle import LifecycleManager
from aionode.programs._wall_timer import create_wall_timer

__all__ = ["Manager", "main"]

WATCH_SEC: Final = 0.2
DIAGNOSTICS_SEC: Final = 1.0
PATIENCE_SEC: Final = 20.0
"""How often it logs again which node it is waiting for."""

HEALTH: Final = {
    "active": (DiagnosticStatus.OK, "Managed nodes are active"),
    "inactive": (DiagnosticStatus.OK, "Managed nodes are inactive"),
    "unconfigured": (DiagnosticStatus.OK, "Managed nodes are unconfigured"),
    "finalized": (DiagnosticStatus.WARN, "Managed nodes have been shut down"),
    "unknown": (DiagnosticStatus.ERROR, "An error has occurred during a node state transition"),
}


class Manager(Node):
    """Manages the nodes of the parameter `node_names`, on requests to its service `~/manage_nodes`.

    When a node is lost, all others are brought down; when all are back within
    `bond_respawn_max_duration`, they are brought up again.
    """

    def __init__(self) -> None:
        super().__init__("lifecycle_manager")
        names = self.declare_parameter("node_names", Parameter.Type.STRING_ARRAY)
        if not names.value:
            raise CommandError("parameter 'node_names' is required: the nodes to manage, in order")
        self.names = list(names.value)
        self.starts_itself = self.declare_parameter("autostart", False).value
        self.bond_timeout = self.declare_parameter("bond_timeout", 4.0).value
        self.respawn_sec = self.declare_parameter("bond_respawn_max_duration", 10.0).value
        self.restores = self.declare_parameter("attempt_respawn_reconnection", True).value
        self.declare_parameter("bond_heartbeat_period", 0.25)
        timeout = self.declare_parameter("service_timeout", 5.0).value
        self.manager = LifecycleManager(self, self.names, timeout_sec=timeout)
        self.changers = {
            name: self.create_client(ChangeState, f"{name}/change_state") for name in self.names
        }
        self.state = "unconfigured"
        self.lost_ns: int | None = None
        latched = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.activity = self.create_publisher(Bool, "~/managed_nodes_activated", latched)
        self.diagnostics = self.create_publisher(DiagnosticArray, "/diagnostics", 1)
        self.tell(self.state)
        self.create_service(ManageLifecycleNodes, "~/manage_nodes", self.manage)
        self.create_service(Trigger, "~/is_active", self.answer)
        create_wall_timer(self, DIAGNOSTICS_SEC, self.diagnose)
        create_wall_timer(self, WATCH_SEC, self.watch)
        self.beginning: Timer = create_wall_timer(self, 0.001, self.begin)

    def tell(self, state: str) -> None:
        """Record the common state of the nodes, and publish whether they are active."""
        self.state = state
        self.activity.publish(Bool(data=state == "active"))

    async def begin(self) -> None:
        """Wait for the nodes, and bring them up if `autostart` is set."""
        self.beginning.cancel()
        for name, client in self.changers.items():
            while not await client.wait_for_service(PATIENCE_SEC):
                self.get_logger().info(f"Waiting for service {name}/change_state...")
        if self.starts_itself:
            await self.startup()

    async def manage(self, request: Any, response: Any) -> Any:
        """Carry out a request."""
        kind = ManageLifecycleNodes.Request
        action = {
            kind.STARTUP: self.startup,
            kind.PAUSE: self.pause,
            kind.RESUME: self.resume,
            kind.RESET: self.reset,
            kind.SHUTDOWN: self.shutdown,
            kind.CONFIGURE: self.configure,
            kind.CLEANUP: self.cleanup,
        }.get(request.command)
        response.success = action is not None and await action()
        return response

    def answer(self, _request: Any, response: Any) -> Any:
        """Answer whether the nodes are active."""
        response.success = self.state == "active"
        return response

    async def change(
        self, label: str, doing: str, *, reverse: bool = False, goes_on: bool = False
    ) -> bool:
        """Request a transition from all nodes; return whether all succeeded.

        The first failure ends it, unless it `goes_on`.
        """
        is_done = True
        for name in reversed(self.names) if reverse else self.names:
            self.get_logger().info(f"{doing} {name}")
            try:
                await self.manager.change_state(name, label)
            except AionodeError as error:
                self.get_logger().error(f"Failed to change state for node: {name}. {error}")
                is_done = False
                if not goes_on:
                    break
        return is_done

    async def carry_out(
        self, state: str, doing: Awaitable[bool], begun: str, done: str, failed: str
    ) -> bool:
        """Await a step, log how it goes, and publish the state of the nodes afterwards."""
        self.get_logger().info(begun)
        if await doing:
            self.get_logger().info(done)
            self.tell(state)
            return True
        self.get_logger().error(failed)
        self.tell("unknown")
        return False

    async def startup(self) -> bool:
        """Configure and activate all nodes."""
        return await self.carry_out(
            "active",
            self.bring_up(),
            "Starting managed nodes bringup...",
            "Managed nodes are active",
            "Failed to bring up all requested nodes. Aborting bringup.",
        )

    async def configure(self) -> bool:
        """Configure all nodes."""
        return await self.carry_out(
            "inactive",
            self.change("configure", "Configuring"),
            "Configuring managed nodes...",
            "Managed nodes are now configured",
            "Failed to configure all requested nodes. Aborting bringup.",
        )

    async def cleanup(self) -> bool:
        """Clean all nodes up."""
        return await self.carry_out(
            "unconfigured",
            self.change("cleanup", "Cleaning up", reverse=True),
            "Cleaning up managed nodes...",
            "Managed nodes have been cleaned up",
            "Failed to cleanup all requested nodes. Aborting cleanup.",
        )

    async def pause(self) -> bool:
        """Deactivate all nodes."""
        return await self.carry_out(
            "inactive",
            self.change("deactivate", "Deactivating", reverse=True),
            "Pausing managed nodes...",
            "Managed nodes have been paused",
            "Failed to pause nodes: aborting pause",
        )

    async def resume(self) -> bool:
        """Activate all nodes."""
        return await self.carry_out(
            "active",
            self.change("activate", "Activating"),
            "Resuming managed nodes...",
            "Managed nodes are active",
            "Failed to resume nodes: aborting resume",
        )

    async def reset(self) -> bool:
        """Bring all nodes down, from any state."""
        return await self.carry_out(
            "unconfigured",
            self.bring_down(),
            "Resetting managed nodes...",
            "Managed nodes have been reset",
            "Failed to reset nodes: aborting reset",
        )

    async def shutdown(self) -> bool:
        """Bring all nodes down from any state, and finalize those that are there."""
        return await self.carry_out(
            "finalized",
            self.finalize(),
            "Shutting down managed nodes...",
            "Managed nodes have been shut down",
            "Failed to shut down all nodes",
        )

    async def bring_up(self) -> bool:
        """Configure, then activate all nodes."""
        return await self.change("configure", "Configuring") and await self.change(
            "activate", "Activating"
        )

    async def bring_down(self) -> bool:
        """Deactivate and clean up what is active or inactive."""
        try:
            await self.manager.reset()
        except ExceptionGroup as group:
            for error in group.exceptions:
                self.get_logger().error(f"Failed to change state: {error}")
            return False
        return True

    async def finalize(self) -> bool:
        """Bring all nodes down and finalize them, even if one of them is gone."""
        is_down = await self.bring_down()
        return (
            await self.change("shutdown", "Shutting down", reverse=True, goes_on=True) and is_down
        )

    async def watch(self) -> None:
        """Bring all nodes down if one is lost, and up again if all return in time."""
        if self.bond_timeout <= 0:
            return
        gone = [name for name, client in self.changers.items() if not client.service_is_ready()]
        if self.state == "active":
            if gone:
                self.get_logger().error(
                    f"CRITICAL FAILURE: SERVER {gone[0]} IS DOWN. Shutting down related nodes."
                )
                await self.reset()
                self.tell("unconfigured")
                self.lost_ns = self.get_clock().now().nanoseconds if self.restores else None
        elif self.lost_ns is not None:
            passed = (self.get_clock().now().nanoseconds - self.lost_ns) / 1e9
            if not gone:
                self.lost_ns = None
                self.get_logger().info(
                    "Successfully re-established connections from server respawns, starting back "
                    "up."
                )
                await self.startup()
            elif passed >= self.respawn_sec:
                self.lost_ns = None
                self.get_logger().info(
                    "Failed to re-establish connection from a server crash after maximum timeout."
                )

    def diagnose(self) -> None:
        """Publish the health of the nodes."""
        level, message = HEALTH[self.state]
        status = DiagnosticStatus(
            level=level,
            name=f"{self.get_name()}: Nav2 Health",
            message=message,
            hardware_id="Nav2",
        )
        msg = DiagnosticArray(status=[status])
        msg.header.stamp = self.get_clock().now().to_msg()
        self.diagnostics.publish(msg)


def main() -> None:
    """Run the node until Ctrl-C."""
    aionode.run(Manager)
