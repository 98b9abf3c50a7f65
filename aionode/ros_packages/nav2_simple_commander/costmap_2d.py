"""`nav2_simple_commander.costmap_2d`: a costmap in numpy."""

from __future__ import annotations

from typing import Any

import numpy as np

__all__ = ["PyCostmap2D"]


class PyCostmap2D:
    """The costs of an `OccupancyGrid`, cell by cell, row after row.

    Args:
        occupancy_map: The message.
    """

    def __init__(self, occupancy_map: Any) -> None:
        info = occupancy_map.info
        self.size_x = info.width
        self.size_y = info.height
        self.resolution = info.resolution
        self.origin_x = info.origin.position.x
        self.origin_y = info.origin.position.y
        self.global_frame_id = occupancy_map.header.frame_id
        self.costmap_timestamp = occupancy_map.header.stamp
        self.costmap = np.array(occupancy_map.data, dtype=np.int8).astype(np.uint8)

    def getSizeInCellsX(self) -> int:
        """Return how many cells a row has."""
        return int(self.size_x)

    def getSizeInCellsY(self) -> int:
        """Return how many rows there are."""
        return int(self.size_y)

    def getSizeInMetersX(self) -> float:
        """Return how far it is from the first corner to the middle of the last cell of a row."""
        return float((self.size_x - 1 + 0.5) * self.resolution)

    def getSizeInMetersY(self) -> float:
        """Return how far it is from the first corner to the middle of the last row."""
        return float((self.size_y - 1 + 0.5) * self.resolution)

    def getOriginX(self) -> float:
        """Return where the first corner is, in metres."""
        return float(self.origin_x)

    def getOriginY(self) -> float:
        """Return where the first corner is, in metres."""
        return float(self.origin_y)

    def getResolution(self) -> float:
        """Return the length of a cell in metres."""
        return float(self.resolution)

    def getGlobalFrameID(self) -> str:
        """Return the frame of the map."""
        return str(self.global_frame_id)

    def getCostmapTimestamp(self) -> Any:
        """Return when the map was made."""
        return self.costmap_timestamp

    def getCostXY(self, mx: int, my: int) -> np.uint8:
        """Return the cost of a cell."""
        return self.getCostIdx(self.getIndex(mx, my))

    def getCostIdx(self, index: int) -> np.uint8:
        """Return the cost of a cell by its number."""
        cost: np.uint8 = self.costmap[index]
        return cost

    def setCost(self, mx: int, my: int, cost: int) -> None:
        """Set the cost of a cell."""
        self.costmap[self.getIndex(mx, my)] = cost

    def mapToWorld(self, mx: int, my: int) -> tuple[float, float]:
        """Return the middle of a cell, in metres."""
        x, y = ((cell + 0.5) * self.resolution for cell in (mx, my))
        return self.origin_x + x, self.origin_y + y

    def worldToMapValidated(self, wx: float, wy: float) -> tuple[int, int] | tuple[None, None]:
        """Return the cell of a place in metres; (None, None) outside of the map."""
        if wx < self.origin_x or wy < self.origin_y:
            return None, None
        mx = int((wx - self.origin_x) // self.resolution)
        my = int((wy - self.origin_y) // self.resolution)
        return (mx, my) if mx < self.size_x and my < self.size_y else (None, None)

    def getIndex(self, mx: int, my: int) -> int:
        """Return the number of a cell."""
        return int(my * self.size_x + mx)
