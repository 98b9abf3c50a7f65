"""Interfaces of unitree_api: requests to robots of Unitree, and their responses."""
