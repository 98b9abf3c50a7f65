"""Requests to a controller manager."""

from __future__ import annotations

from typing import Any, Final

from aionode import Node
from aionode.errors import CommandError, RequestTimeoutError
from aionode.interfaces.controller_manager_msgs import srv
from aionode.interfaces.rcl_interfaces.srv import SetParameters
from aionode.parameter import Parameter

__all__ = ["ManagerClient", "manager_name"]

ATTEMPTS: Final = 3
PATIENCE_SEC: Final = 10.0


def manager_name(node: Node, given: str, namespace: str = "") -> str:
    """Return the full name of a controller manager, which is relative to the namespace."""
    if given.startswith("/"):
        return given
    namespace = (namespace or node.get_namespace()).strip("/")
    return f"/{namespace}/{given}" if namespace else f"/{given}"


class ManagerClient:
    """Calls the services of a controller manager.

    Args:
        node: The node that calls.
        manager: The full name of the manager.
        wait_sec: How long to wait for the manager; 0 means forever.
        call_sec: How long to wait for each answer.
    """

    def __init__(
        self, node: Node, manager: str, *, wait_sec: float = 0.0, call_sec: float = 10.0
    ) -> None:
        self.node = node
        self.manager = manager
        self.wait_sec = wait_sec
        self.call_sec = call_sec

    async def call(self, kind: Any, name: str, request: Any) -> Any:
        """Call a service, and return the answer.

        Raises:
            CommandError: The service does not become available in time, or does not answer.
        """
        service = f"{self.manager}/{name}"
        client = self.node.create_client(kind, service)
        logger = self.node.get_logger()
        while not client.service_is_ready():
            logger.info(f"waiting for service {service} to become available...")
            if await client.wait_for_service(self.wait_sec or PATIENCE_SEC):
                break
            if self.wait_sec:
                raise CommandError(f"Could not contact service {service}")
            logger.warning(f"Could not contact service {service}")
        try:
            for attempt in range(1, ATTEMPTS + 1):
                try:
                    return await client.call(request, self.call_sec)
                except RequestTimeoutError:
                    logger.warning(
                        f"Failed getting a result from calling {service} in {self.call_sec:g}. "
                        f"(Attempt {attempt} of {ATTEMPTS}.)"
                    )
        finally:
            self.node.destroy_client(client)
        raise CommandError(
            f"Could not successfully call service {service} after {ATTEMPTS} attempts."
        )

    async def is_loaded(self, controller: str) -> bool:
        """Return whether a controller is loaded."""
        answer = await self.call(
            srv.ListControllers, "list_controllers", srv.ListControllers.Request()
        )
        return any(each.name == controller for each in answer.controller)

    async def switch(
        self, *, start: list[str], stop: list[str], asap: bool, timeout_sec: float
    ) -> bool:
        """Activate and deactivate controllers; return whether all of them were switched."""
        kind = srv.SwitchController
        request = kind.Request(
            activate_controllers=start,
            deactivate_controllers=stop,
            strictness=kind.Request.STRICT,
            activate_asap=asap,
        )
        request.timeout.sec, rest = divmod(round(timeout_sec * 1e9), 10**9)
        request.timeout.nanosec = rest
        return bool((await self.call(kind, "switch_controller", request)).ok)

    async def set_parameter(self, controller: str, name: str, value: Any) -> None:
        """Set a controller's parameter in the manager.

        Raises:
            CommandError: The manager refuses it.
        """
        parameter = Parameter(f"{controller}.{name}", value=value).to_parameter_msg()
        answer = await self.call(
            SetParameters, "set_parameters", SetParameters.Request(parameters=[parameter])
        )
        result = answer.results[0] if len(answer.results) == 1 else None
        if result is None or not result.successful:
            raise CommandError(
                f'Could not set controller param "{name}" to "{value}" for {controller}: '
                + ("the answer has no result" if result is None else result.reason)
            )
        self.node.get_logger().info(
            f'Setting controller param "{name}" to "{value}" for {controller}'
        )
