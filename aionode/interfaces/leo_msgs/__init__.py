"""Interfaces of leo_msgs: wheels, encoders and the IMU of the Leo Rover."""
