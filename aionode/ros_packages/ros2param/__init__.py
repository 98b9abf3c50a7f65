"""Programs import `ros2param.api`: the functions behind `ros2 param`."""
