"""Interfaces of velodyne_msgs: packets of the lidars of Velodyne."""
