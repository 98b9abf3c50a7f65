"""``diagnostic_aggregator add_analyzer``: adds analyzers to a running aggregator."""

from __future__ import annotations

from typing import Final

import aionode
from aionode import Node
from aionode.errors import CommandError
from aionode.interfaces.rcl_interfaces.srv import SetParametersAtomically

__all__ = ["AddAnalyzer", "main"]

SERVICE: Final = "/analyzers/set_parameters_atomically"


class AddAnalyzer(Node):
    """Sets its own parameters that describe analyzers on the aggregator."""

    def __init__(self) -> None:
        super().__init__(
            "add_analyzer_node",
            allow_undeclared_parameters=True,
            automatically_declare_parameters_from_overrides=True,
        )
        self.client = self.create_client(SetParametersAtomically, SERVICE)

    async def add(self) -> None:
        """Wait for the aggregator, and set the parameters.

        Raises:
            CommandError: There are none, or the aggregator refuses one.
        """
        known = self.get_parameters_by_prefix("")
        chosen = [
            parameter
            for name, parameter in sorted(known.items())
            if f"{name.rpartition('.')[0]}.path" in known
        ]
        if not chosen:
            raise CommandError(
                "no parameters of an analyzer are given; each needs a path: --ros-args "
                "--params-file FILE"
            )
        for parameter in chosen:
            self.get_logger().info(parameter.name)
        if not self.client.service_is_ready():
            self.get_logger().info("service not available, waiting ...")
            await self.client.wait_for_service()
        messages = [parameter.to_parameter_msg() for parameter in chosen]
        response = await self.client.call(SetParametersAtomically.Request(parameters=messages))
        if not response.result.successful:
            raise CommandError(f"Failed to set parameters: {response.result.reason}")
        self.get_logger().info("Parameters succesfully set")


async def add_and_end() -> None:
    """Run the node until it has done its work."""
    async with AddAnalyzer() as node:
        await node.add()


def main() -> None:
    """Add the analyzers, or wait until Ctrl-C."""
    aionode.run(add_and_end)
