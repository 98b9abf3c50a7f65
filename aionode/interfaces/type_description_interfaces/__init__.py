"""type_description_interfaces."""
