"""rcl_interfaces."""
