"""composition_interfaces."""
