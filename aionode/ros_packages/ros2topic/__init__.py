"""Programs import `ros2topic.api`: the functions behind `ros2 topic`."""
