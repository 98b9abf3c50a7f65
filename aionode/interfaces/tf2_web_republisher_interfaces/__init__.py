"""Interfaces of tf2_web_republisher_interfaces: transforms for browsers."""
