"""Interfaces of composition_interfaces: loading nodes into a container."""
