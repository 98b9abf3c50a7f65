"""shape_msgs."""
