"""The parts from which rclpy's modules are built: handles, queues, and the thread of a context."""
