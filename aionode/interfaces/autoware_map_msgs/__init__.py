"""Interfaces of autoware_map_msgs: maps of lanes and of point clouds."""
