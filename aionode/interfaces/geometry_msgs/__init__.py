"""Interfaces of geometry_msgs: points, rotations, poses, velocities and forces."""
