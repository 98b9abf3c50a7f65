"""Interfaces of webots_ros2_msgs: sensors and scenes of the simulator Webots."""
