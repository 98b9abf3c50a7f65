"""Interfaces of autoware_v2x_msgs: what a vehicle and the infrastructure exchange."""
