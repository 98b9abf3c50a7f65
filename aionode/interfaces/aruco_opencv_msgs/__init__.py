"""Interfaces of aruco_opencv_msgs: markers of ArUco that were found in images."""
