"""Programs import `ros2action.api`: the functions behind `ros2 action`."""
