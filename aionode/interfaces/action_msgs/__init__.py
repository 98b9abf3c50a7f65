"""action_msgs."""
