"""Interfaces of example_interfaces: types for examples."""
