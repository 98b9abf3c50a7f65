"""Interfaces of builtin_interfaces: time and duration."""
