"""One participant of a ROS 2 system: what asyncio's nodes and programs of rclpy stand on."""
