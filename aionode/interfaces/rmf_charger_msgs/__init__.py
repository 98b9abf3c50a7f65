"""Interfaces of rmf_charger_msgs: chargers and requests to them."""
