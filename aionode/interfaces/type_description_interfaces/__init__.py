"""Interfaces of type_description_interfaces: descriptions of types."""
