"""Interfaces of clearpath_platform_msgs: power, lights, fans and stops of the platforms of Clearpath."""
