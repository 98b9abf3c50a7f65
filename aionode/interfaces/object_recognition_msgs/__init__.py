"""Interfaces of object_recognition_msgs: recognized objects and tables."""
