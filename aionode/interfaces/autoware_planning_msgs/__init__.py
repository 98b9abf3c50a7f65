"""Interfaces of autoware_planning_msgs: routes, paths and trajectories of a vehicle."""
