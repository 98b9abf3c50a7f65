"""Interfaces of geographic_msgs: places, maps and routes on the earth."""
