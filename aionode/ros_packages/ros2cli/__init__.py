"""Programs import this as `ros2cli`: nodes for commands, and base classes of commands."""
