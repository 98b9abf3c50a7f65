"""Interfaces of rtabmap_msgs: graphs, features and sensor data of RTAB-Map."""
