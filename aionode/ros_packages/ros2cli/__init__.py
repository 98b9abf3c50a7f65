"""Programs import this as `ros2cli`: nodes for commands, and the bases of commands."""
