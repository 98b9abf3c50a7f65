"""Interfaces of rmf_site_map_msgs: the map of a site."""
