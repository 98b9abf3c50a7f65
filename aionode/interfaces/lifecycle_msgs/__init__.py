"""lifecycle_msgs."""
