"""Interfaces of autoware_system_msgs: the state of Autoware and of its parts."""
