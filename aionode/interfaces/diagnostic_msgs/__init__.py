"""diagnostic_msgs."""
