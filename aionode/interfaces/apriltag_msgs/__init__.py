"""Interfaces of apriltag_msgs: tags of AprilTag that were found in images."""
