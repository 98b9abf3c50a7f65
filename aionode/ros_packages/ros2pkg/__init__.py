"""Programs import `ros2pkg.api`: the functions behind `ros2 pkg`."""
