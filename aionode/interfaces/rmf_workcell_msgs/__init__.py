"""Interfaces of rmf_workcell_msgs: work cells, and requests to them."""
