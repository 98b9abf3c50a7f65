"""trajectory_msgs."""
