"""Information about connections from Zenoh and the system: configurations, sockets, handlers."""
