"""The wire format of ROS 2, under its public names."""
