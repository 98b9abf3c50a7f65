"""Interfaces of grid_map_msgs: maps in cells with several layers."""
