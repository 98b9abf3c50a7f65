"""Programs import this as `sensor_msgs_py`: point clouds as numpy arrays."""
