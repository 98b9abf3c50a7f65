"""Interfaces of statistics_msgs: statistics of topics."""
