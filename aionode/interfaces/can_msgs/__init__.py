"""Interfaces of can_msgs: frames of a CAN bus."""
