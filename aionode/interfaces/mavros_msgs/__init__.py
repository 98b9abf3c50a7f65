"""Interfaces of mavros_msgs: flight controllers behind MAVLink."""
