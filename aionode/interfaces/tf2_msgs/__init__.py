"""tf2_msgs."""
