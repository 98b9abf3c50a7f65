"""The package that programs import as `rosidl_parser`: the types of fields."""
