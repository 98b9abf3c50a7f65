"""Interfaces of autoware_perception_msgs: objects and traffic lights, as seen and as predicted."""
