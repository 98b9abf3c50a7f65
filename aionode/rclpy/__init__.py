"""rclpy's API on aionode, for programs that run on rclpy today."""
