"""Programs import `ros2run.api`: the functions behind `ros2 run`."""
