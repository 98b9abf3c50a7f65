"""Interfaces of map_msgs: parts of maps, and maps of points."""
