"""nav_msgs."""
