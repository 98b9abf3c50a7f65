"""`nav2_simple_commander.footprint_collision_checker`: the costs under a robot's footprint."""

from __future__ import annotations

from math import cos, sin
from typing import Any, Final

from geometry_msgs.msg import Point32, Polygon

from nav2_simple_commander.costmap_2d import PyCostmap2D
from nav2_simple_commander.line_iterator import LineIterator

__all__ = ["FootprintCollisionChecker"]

NO_INFORMATION: Final = 255
LETHAL_OBSTACLE: Final = 254
INSCRIBED_INFLATED_OBSTACLE: Final = 253
MAX_NON_OBSTACLE: Final = 252
FREE_SPACE: Final = 0


class FootprintCollisionChecker:
    """Finds the greatest cost that the edges of a footprint lie on."""

    def __init__(self) -> None:
        self.costmap_: PyCostmap2D | None = None

    def setCostmap(self, costmap: PyCostmap2D) -> None:
        """Set the costmap to use."""
        self.costmap_ = costmap

    def footprintCost(self, footprint: Any) -> float:
        """Return the greatest cost under a polygon's edges; 254 if it is not within the map.

        Raises:
            ValueError: There is no costmap.
        """
        cells = [self.worldToMapValidated(point.x, point.y) for point in footprint.points]
        greatest = 0.0
        for (x0, y0), (x1, y1) in zip(cells, [*cells[1:], *cells[:1]], strict=True):
            if x0 is None or y0 is None or x1 is None or y1 is None:
                return LETHAL_OBSTACLE
            greatest = max(greatest, float(self.lineCost(x0, x1, y0, y1)))
            if greatest == LETHAL_OBSTACLE:
                break
        return greatest

    def footprintCostAtPose(self, x: float, y: float, theta: float, footprint: Any) -> float:
        """Return the greatest cost under a polygon that is turned, then moved."""
        along, across = cos(theta), sin(theta)
        moved = Polygon(
            points=[
                Point32(
                    x=x + point.x * along - point.y * across,
                    y=y + point.x * across + point.y * along,
                )
                for point in footprint.points
            ]
        )
        return self.footprintCost(moved)

    def lineCost(self, x0: int, x1: int, y0: int, y1: int, step_size: float = 0.5) -> float:
        """Return the greatest cost under a line between two cells, which may be the same cell."""
        if (x0, y0) == (x1, y1):
            return float(self.pointCost(x0, y0))
        greatest = 0.0
        line = LineIterator(x0, y0, x1, y1, step_size)
        while line.isValid() and greatest != LETHAL_OBSTACLE:
            cost = float(self.pointCost(int(line.getX()), int(line.getY())))
            greatest = cost if cost == LETHAL_OBSTACLE else max(greatest, cost)
            line.advance()
        return greatest

    def worldToMapValidated(self, wx: float, wy: float) -> tuple[int, int] | tuple[None, None]:
        """Return the cell of a place in metres; (None, None) outside of the map."""
        return self.known().worldToMapValidated(wx, wy)

    def pointCost(self, x: int, y: int) -> Any:
        """Return the cost of a cell."""
        return self.known().getCostXY(x, y)

    def known(self) -> PyCostmap2D:
        """Return the costmap.

        Raises:
            ValueError: There is none.
        """
        if self.costmap_ is None:
            raise ValueError("Costmap not specified, use setCostmap to specify the costmap first")
        return self.costmap_
