"""Interfaces of service_msgs: service introspection."""
