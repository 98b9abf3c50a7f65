"""Interfaces of rmf_ingestor_msgs: ingestors that take items from robots."""
