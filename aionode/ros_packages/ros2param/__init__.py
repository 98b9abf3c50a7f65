"""Programs import `ros2param.api`: what `ros2 param` is made of."""
