"""Interfaces of turtlebot3_msgs: sensors, sounds, version and patrol of the TurtleBot 3."""
