"""Programs import `ros2node.api`: the functions behind `ros2 node`."""
