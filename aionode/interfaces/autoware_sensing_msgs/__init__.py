"""Interfaces of autoware_sensing_msgs: the orientation that a GNSS receiver measures, and point clouds of radars."""
