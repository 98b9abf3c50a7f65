"""Interfaces of irobot_create_msgs: the mobile base iRobot Create 3."""
