"""Interfaces of micro_ros_msgs: nodes and entities of a micro-ROS graph."""
