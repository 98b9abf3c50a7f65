"""The parts from which rclpy's modules are built: handles, queues, and a context's thread."""
