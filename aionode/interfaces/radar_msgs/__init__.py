"""Interfaces of radar_msgs: returns and tracks of radars."""
