"""Interfaces of nav_msgs: maps, paths and odometry."""
