"""Interfaces of visualization_msgs: things to draw in 3D views."""
