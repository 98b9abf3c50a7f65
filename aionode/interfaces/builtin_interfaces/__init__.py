"""builtin_interfaces."""
