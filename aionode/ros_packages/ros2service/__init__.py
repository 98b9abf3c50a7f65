"""Programs import `ros2service.api`: the functions behind `ros2 service`."""
