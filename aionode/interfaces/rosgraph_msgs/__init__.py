"""Interfaces of rosgraph_msgs: simulated time."""
