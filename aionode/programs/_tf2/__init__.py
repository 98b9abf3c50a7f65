"""Programs of tf2_ros that look transforms up."""
