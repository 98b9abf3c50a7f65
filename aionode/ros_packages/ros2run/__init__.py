"""Programs import `ros2run.api`: what `ros2 run` is made of."""
