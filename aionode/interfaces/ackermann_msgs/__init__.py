"""Interfaces of ackermann_msgs: how vehicles with steered wheels are to drive."""
