"""Interfaces of diagnostic_msgs: the health of a robot."""
