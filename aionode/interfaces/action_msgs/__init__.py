"""Interfaces of action_msgs."""
