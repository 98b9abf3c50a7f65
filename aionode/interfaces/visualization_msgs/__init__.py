"""visualization_msgs."""
