"""Interfaces of rai_interfaces: what the embodied agents of RAI exchange."""
