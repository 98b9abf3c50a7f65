"""Interfaces of rmf_building_map_msgs: buildings with their levels, lifts, doors and graphs."""
