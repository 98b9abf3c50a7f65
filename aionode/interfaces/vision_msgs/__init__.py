"""Interfaces of vision_msgs: objects that were recognized in images and in space."""
