"""service_msgs."""
