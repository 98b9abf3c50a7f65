"""The wire format of ROS 2 on Zenoh, without input and output."""
