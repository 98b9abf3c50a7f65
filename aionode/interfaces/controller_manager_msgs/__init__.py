"""Interfaces of controller_manager_msgs: controllers and hardware of ros2_control."""
