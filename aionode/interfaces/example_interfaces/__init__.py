"""example_interfaces."""
