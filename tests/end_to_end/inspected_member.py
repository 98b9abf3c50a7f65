"""A node that prints whether numpy is loaded when its parameter ``end`` is set.

With ``aionode run`` it is a program of rclpy.
"""

from __future__ import annotations

import sys
from typing import Any


def tell(text: str) -> None:
    """Write a line."""
    sys.stdout.write(f"{text}\n")
    sys.stdout.flush()


def noting(result: type[Any]) -> Any:
    """Return a callback for changes of parameters."""

    def note(parameters: list[Any]) -> Any:
        if any(parameter.name == "end" for parameter in parameters):
            tell(f"numpy {'numpy' in sys.modules}")
        return result(successful=True)

    return note


def declare(node: Any, result: type[Any]) -> None:
    """Declare the parameters."""
    node.declare_parameter("speed", 1.0)
    node.declare_parameter("end", False)  # its value
    node.add_on_set_parameters_callback(noting(result))
    tell("ready")


def with_aionode() -> None:
    """Run a node of aionode."""
    import aionode
    from aionode.interfaces.rcl_interfaces.msg import SetParametersResult

    class Inspected(aionode.Node):
        def __init__(self) -> None:
            super().__init__("inspected")
            declare(self, SetParametersResult)

    aionode.run(Inspected)


def with_rclpy() -> None:
    """Spin a node of rclpy."""
    from rcl_interfaces.msg import SetParametersResult

    import rclpy

    rclpy.init()
    node = rclpy.create_node("inspected")
    declare(node, SetParametersResult)
    rclpy.spin(node)


if __name__ == "__main__":
    if "rclpy" in sys.argv:
        with_rclpy()
    else:
        with_aionode()
