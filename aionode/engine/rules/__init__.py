"""Rules of ROS 2, as values and state machines: no input or output, and no tasks."""
