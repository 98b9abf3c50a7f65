"""Programs import `ros2topic.api`: what `ros2 topic` is made of."""
