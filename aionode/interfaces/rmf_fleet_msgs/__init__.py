"""Interfaces of rmf_fleet_msgs: fleets of robots, their states, and where they are to go."""
