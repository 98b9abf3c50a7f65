"""What programs know as `sensor_msgs_py`: point clouds as numpy arrays."""
