"""Programs import this as `rosidl_parser`: the types of fields."""
