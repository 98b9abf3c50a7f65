"""Interfaces of autoware_simulation_msgs: what is simulated, and how."""
