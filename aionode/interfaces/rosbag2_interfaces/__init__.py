"""Interfaces of rosbag2_interfaces: recording and playing."""
