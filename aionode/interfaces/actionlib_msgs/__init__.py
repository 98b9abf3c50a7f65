"""actionlib_msgs."""
