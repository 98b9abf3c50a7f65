"""Interfaces of std_msgs: single values, and the header."""
