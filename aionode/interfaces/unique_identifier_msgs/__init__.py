"""Interfaces of unique_identifier_msgs: unique ids."""
