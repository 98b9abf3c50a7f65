"""What the modules of rclpy are made of: handles, queues, and the thread that does input and output.

Programs use `rclpy_implementation`, as they do with rclpy; the other modules are private.
"""
