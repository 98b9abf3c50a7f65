"""Interfaces of turtlebot4_msgs: buttons, lights and display of the TurtleBot 4."""
