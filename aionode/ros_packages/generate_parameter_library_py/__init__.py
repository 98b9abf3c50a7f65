"""Modules that generate_parameter_library generates import `python_validators` of this package."""
