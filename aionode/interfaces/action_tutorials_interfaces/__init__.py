"""action_tutorials_interfaces."""
