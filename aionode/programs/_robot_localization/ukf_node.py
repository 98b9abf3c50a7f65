"""``robot_localization ukf_node``: an unscented Kalman filter."""

from __future__ import annotations

import aionode
from aionode import Node
from aionode.errors import CommandError
from aionode.programs._robot_localization.filter_node import FilterNode
from aionode.programs._robot_localization.kalman import Ukf

__all__ = ["UkfNode", "main"]


class UkfNode(FilterNode):
    """Estimates with a filter that moves sample points around the estimate."""

    def __init__(self) -> None:
        super().__init__("ukf_filter_node", filter_of)


def filter_of(node: Node) -> Ukf:
    """Return the filter, with the parameters of a node.

    Raises:
        CommandError: The parameters leave no sample points around the estimate.
    """
    alpha, kappa, beta = (
        node.declare_parameter(name, default).value
        for name, default in (("alpha", 0.001), ("kappa", 0.0), ("beta", 2.0))
    )
    try:
        return Ukf(alpha, kappa, beta)
    except ValueError as error:
        raise CommandError(f"alpha and kappa: {error}") from None


def main() -> None:
    """Run the node until Ctrl-C."""
    aionode.run(UkfNode)
