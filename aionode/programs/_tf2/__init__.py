"""Programs of tf2_ros that print transforms."""
