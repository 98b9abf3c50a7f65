"""ROS 2's rules as values and state machines: no I/O and no tasks."""
