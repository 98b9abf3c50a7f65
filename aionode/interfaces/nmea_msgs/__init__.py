"""Interfaces of nmea_msgs: sentences of NMEA 0183, whole and in their fields."""
