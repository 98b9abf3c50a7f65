"""The parts of which rclpy's modules are made: handles, queues, and the thread of a context."""
