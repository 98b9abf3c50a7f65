"""Interfaces of nav_2d_msgs: poses, paths and velocities in the plane, for Nav2."""
