"""Interfaces of kobuki_ros_interfaces: bumpers, buttons, docking and sounds of the base Kobuki."""
