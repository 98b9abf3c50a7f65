"""geometry_msgs."""
