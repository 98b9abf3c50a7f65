"""``robot_localization ekf_node``: an extended Kalman filter."""

from __future__ import annotations

import aionode
from aionode.programs._robot_localization.filter_node import FilterNode
from aionode.programs._robot_localization.kalman import Ekf

__all__ = ["EkfNode", "main"]


class EkfNode(FilterNode):
    """Estimates with a filter that linearizes the motion around the estimate."""

    def __init__(self) -> None:
        super().__init__("ekf_filter_node", lambda _: Ekf())


def main() -> None:
    """Run the node until Ctrl-C."""
    aionode.run(EkfNode)
