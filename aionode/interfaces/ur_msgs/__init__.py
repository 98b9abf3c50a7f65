"""Interfaces of ur_msgs: inputs, outputs and speed of Universal Robots."""
