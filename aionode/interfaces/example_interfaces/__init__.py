"""Interfaces of example_interfaces."""
