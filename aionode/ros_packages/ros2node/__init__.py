"""Programs import `ros2node.api`: what `ros2 node` is made of."""
