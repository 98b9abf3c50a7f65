"""What the modules of rclpy are made of: handles, queues, and the thread of a context."""
