"""Programs import `ros2lifecycle.api`: the functions behind `ros2 lifecycle`."""
