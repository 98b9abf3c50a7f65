"""The talker and listener with which most tutorials of ROS 2 begin."""
