"""Interfaces of realsense2_camera_msgs: calibration, metadata and extrinsics of the cameras of RealSense."""
