"""A node for a command, configured by its arguments."""

from __future__ import annotations

import os
from argparse import ArgumentParser
from typing import Any, Final, Self

import rclpy
import rclpy.action
from rclpy.parameter import Parameter
from ros2cli.node import NODE_NAME_PREFIX

__all__ = ["DEFAULT_TIMEOUT", "DirectNode", "add_arguments"]

DEFAULT_TIMEOUT: Final = 0.5
"""How long a node waits for discovery, in seconds."""


class DirectNode:
    """A node that waits for discovery when it is created; it initializes and shuts down rclpy.

    It has the attributes of its node, and the graph queries of `rclpy.action` as methods.

    Args:
        args: The parsed arguments of a command, which may include those of `add_arguments`.
        node_name: The node's name; by default, a hidden one.
    """

    def __init__(self, args: Any, *, node_name: str | None = None) -> None:
        rclpy.init(args=getattr(args, "argv", []))
        if node_name is None:
            suffix = getattr(args, "node_name_suffix", f"_{os.getpid()}")
            node_name = NODE_NAME_PREFIX + suffix
        self.node = rclpy.create_node(
            node_name,
            start_parameter_services=getattr(args, "start_parameter_services", False),
            parameter_overrides=[
                Parameter("use_sim_time", value=getattr(args, "use_sim_time", False)),
                Parameter(
                    "start_type_description_service",
                    value=getattr(args, "start_type_description_service", True),
                ),
            ],
            automatically_declare_parameters_from_overrides=True,
        )
        is_over: list[bool] = []
        timer = self.node.create_timer(
            getattr(args, "spin_time", DEFAULT_TIMEOUT), lambda: is_over.append(True)
        )
        while not is_over:
            rclpy.spin_once(self.node)
        self.node.destroy_timer(timer)

    def __enter__(self) -> Self:
        return self

    def get_action_names_and_types(self) -> Any:
        """Return the actions of the graph, with their types."""
        return rclpy.action.get_action_names_and_types(self.node)

    def get_action_client_names_and_types_by_node(
        self, remote_node_name: str, remote_node_namespace: str
    ) -> Any:
        """Return the actions for which a node has clients, with their types."""
        return rclpy.action.get_action_client_names_and_types_by_node(
            self.node, remote_node_name, remote_node_namespace
        )

    def get_action_server_names_and_types_by_node(
        self, remote_node_name: str, remote_node_namespace: str
    ) -> Any:
        """Return the actions for which a node has servers, with their types."""
        return rclpy.action.get_action_server_names_and_types_by_node(
            self.node, remote_node_name, remote_node_namespace
        )

    def __getattr__(self, name: str) -> Any:
        if not rclpy.ok():
            raise RuntimeError("!rclpy.ok()")
        return getattr(self.node, name)

    def __exit__(self, *exc_info: object) -> None:
        self.node.destroy_node()
        rclpy.try_shutdown()


def add_arguments(parser: ArgumentParser) -> None:
    """Add the arguments that a `DirectNode` takes."""
    parser.add_argument(
        "--spin-time",
        type=float,
        default=DEFAULT_TIMEOUT,
        help="Spin time in seconds to wait for discovery",
    )
    parser.add_argument(
        "-s", "--use-sim-time", action="store_true", help="Enable ROS simulation time"
    )
