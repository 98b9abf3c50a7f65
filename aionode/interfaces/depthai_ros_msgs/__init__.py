"""Interfaces of depthai_ros_msgs: detections and features of the cameras of Luxonis."""
