"""Interfaces of zed_msgs: objects, skeletons and services of the cameras of Stereolabs."""
