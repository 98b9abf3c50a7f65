"""imu_tools: estimates the orientation of an IMU from its measurements."""
