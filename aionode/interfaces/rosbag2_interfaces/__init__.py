"""rosbag2_interfaces."""
