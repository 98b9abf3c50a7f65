"""One participant in a ROS 2 system: what asyncio nodes and rclpy programs are built on."""
