"""rosgraph_msgs."""
