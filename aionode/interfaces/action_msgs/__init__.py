"""Interfaces of action_msgs: the messages and the service behind every action."""
