"""The package that programs import as `sensor_msgs_py`: point clouds as numpy arrays."""
