"""Interfaces of create_msgs: sensors and sounds of the Create 1 and 2 and of the Roomba."""
