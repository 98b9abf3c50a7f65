"""Interfaces of autoware_common_msgs: how a request to Autoware ended."""
