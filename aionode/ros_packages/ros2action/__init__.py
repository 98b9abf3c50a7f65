"""Programs import `ros2action.api`: what `ros2 action` is made of."""
