"""Interfaces of tf2_msgs: coordinate frames."""
