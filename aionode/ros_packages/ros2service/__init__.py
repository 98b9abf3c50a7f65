"""Programs import `ros2service.api`: what `ros2 service` is made of."""
