"""Interfaces of autoware_vehicle_msgs: doors, gears, lights, steering and speed of a vehicle."""
