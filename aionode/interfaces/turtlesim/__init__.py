"""Interfaces of turtlesim: the turtles of ROS's first tutorials."""
