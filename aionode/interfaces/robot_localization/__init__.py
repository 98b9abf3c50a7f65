"""Interfaces of robot_localization: the services of robot_localization, such as those that set its pose."""
