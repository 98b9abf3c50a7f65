"""Programs import this as `ros2_numpy`: messages as numpy arrays, and back."""

from __future__ import annotations

from ros2_numpy import geometry, image, occupancy_grid, point_cloud2
from ros2_numpy.registry import msgify, numpify

__all__ = ["geometry", "image", "msgify", "numpify", "occupancy_grid", "point_cloud2"]
