"""What programs know as `rosidl_parser`: the types of fields."""
