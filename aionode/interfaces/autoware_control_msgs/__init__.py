"""Interfaces of autoware_control_msgs: how a vehicle is to steer and to accelerate."""
