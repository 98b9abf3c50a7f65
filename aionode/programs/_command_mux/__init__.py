"""twist_mux and ackermann_mux: of several sources of commands, one is heard."""
