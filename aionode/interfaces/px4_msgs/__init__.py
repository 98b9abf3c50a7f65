"""Interfaces of px4_msgs: topics of the flight controller PX4, release 1.15."""
