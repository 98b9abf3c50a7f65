"""Interfaces of rcl_interfaces: parameters and logs."""
