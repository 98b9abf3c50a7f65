"""Interfaces of actionlib_msgs: goals of ROS 1 actions."""
