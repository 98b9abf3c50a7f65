"""domain_bridge: passes topics from one domain id to another."""
