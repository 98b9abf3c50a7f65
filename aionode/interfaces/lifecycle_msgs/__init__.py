"""Interfaces of lifecycle_msgs: managed nodes."""
