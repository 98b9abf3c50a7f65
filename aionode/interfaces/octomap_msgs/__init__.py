"""Interfaces of octomap_msgs: maps of cells in an octree."""
