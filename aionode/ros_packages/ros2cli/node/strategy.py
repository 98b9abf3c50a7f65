"""A node for a command; in ROS, that of a daemon if one runs."""

from __future__ import annotations

from argparse import ArgumentParser
from typing import Any, Self

from ros2cli.node import direct

__all__ = ["NodeStrategy", "add_arguments"]


class NodeStrategy:
    """A `DirectNode`: there is no daemon.

    Args:
        args: The parsed arguments of a command.
        node_name: The node's name; by default, a hidden one.
    """

    daemon_node = None

    def __init__(self, args: Any, *, node_name: str | None = None) -> None:
        self.direct_node = direct.DirectNode(args, node_name=node_name)

    def __enter__(self) -> Self:
        return self

    def __getattr__(self, name: str) -> Any:
        return getattr(self.direct_node, name)

    def __exit__(self, *exc_info: object) -> None:
        self.direct_node.__exit__(*exc_info)


def add_arguments(parser: ArgumentParser) -> None:
    """Add the arguments that a `NodeStrategy` takes."""
    direct.add_arguments(parser)
    parser.add_argument("--no-daemon", action="store_true", help="without effect: there is none")
