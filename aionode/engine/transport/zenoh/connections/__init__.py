"""What Zenoh and the system tell of connections: configurations, sockets, handlers."""
