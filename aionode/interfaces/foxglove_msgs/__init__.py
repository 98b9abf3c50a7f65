"""Interfaces of foxglove_msgs: what Foxglove draws."""
