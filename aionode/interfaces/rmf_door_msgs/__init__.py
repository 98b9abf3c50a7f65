"""Interfaces of rmf_door_msgs: doors, and requests to open them."""
