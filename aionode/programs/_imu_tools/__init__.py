"""imu_tools: the orientation of an IMU, from what it measures."""
