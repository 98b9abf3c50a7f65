"""Interfaces of rmf_dispenser_msgs: dispensers that put items onto robots."""
