"""Interfaces of cartographer_ros_msgs: submaps, trajectories and landmarks of Cartographer."""
