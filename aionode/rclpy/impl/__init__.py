"""What the modules of rclpy are made of: handles, queues, and the thread of a context.

Programs use `rclpy_implementation`, as they do with rclpy; the other modules are private.
"""
