"""The wire format of ROS 2 on Zenoh; these modules do no I/O."""
