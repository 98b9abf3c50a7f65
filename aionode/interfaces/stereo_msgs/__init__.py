"""Interfaces of stereo_msgs: stereo cameras."""
