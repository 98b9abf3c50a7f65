"""Interfaces of rmf_obstacle_msgs: obstacles in a building."""
