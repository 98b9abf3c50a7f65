"""ROS 2's demos: the talker and listener of most tutorials, and the sensors of a dummy robot."""
