"""statistics_msgs."""
