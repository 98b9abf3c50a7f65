"""Interfaces of rmf_lift_msgs: lifts, and requests to them."""
