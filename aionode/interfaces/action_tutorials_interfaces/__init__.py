"""Interfaces of action_tutorials_interfaces: the action of the tutorials."""
