"""Programs of tf2_ros that look up transforms."""
