"""Parameters that are finite numbers, and the linear conversions that they describe."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Final

from aionode import Node, Parameter
from aionode.errors import CommandError
from aionode.interfaces.rcl_interfaces.msg import ParameterDescriptor

__all__ = ["FIXED", "Line", "number"]

FIXED: Final = ParameterDescriptor(read_only=True)
"""All parameters are read once, at the start."""


def number(node: Node, name: str, default: float | None = None) -> float:
    """Declare a parameter that is a finite number, and return it.

    Args:
        node: The node that has it.
        name: Its name.
        default: Its value if it is not given; None for a parameter that has to be given.

    Raises:
        CommandError: It is missing, or not finite.
    """
    kind: Any = Parameter.Type.DOUBLE if default is None else default
    value = node.declare_parameter(name, kind, FIXED).value
    if value is None:
        raise CommandError(f"parameter '{name}' is missing; it has to be a number, such as 1.0")
    if not math.isfinite(value):
        raise CommandError(f"parameter '{name}' is {value}; it has to be a finite number")
    return float(value)


@dataclass(frozen=True)
class Line:
    """Converts a number to ``gain * number + offset``."""

    gain: float
    offset: float

    @classmethod
    def declared(cls, node: Node, name: str) -> Line:
        """Return the conversion that the parameters ``NAME_gain`` and ``NAME_offset`` describe.

        Raises:
            CommandError: A parameter is missing, or not finite.
        """
        return cls(number(node, f"{name}_gain"), number(node, f"{name}_offset"))

    def convert(self, value: float) -> float:
        """Return the converted number."""
        return self.gain * value + self.offset

    def invert(self, value: float) -> float:
        """Return the number that is converted to a given one; the gain is not 0."""
        return (value - self.offset) / self.gain
