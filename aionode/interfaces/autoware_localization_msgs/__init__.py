"""Interfaces of autoware_localization_msgs: where a vehicle is and how it is initialized."""
