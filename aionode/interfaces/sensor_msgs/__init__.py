"""Interfaces of sensor_msgs: what sensors measure."""
