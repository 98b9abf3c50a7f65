"""Interfaces of rmf_traffic_msgs: itineraries of robots, and how their conflicts are negotiated."""
