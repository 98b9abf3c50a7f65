"""twist_mux and ackermann_mux: pass on the commands of one of several sources."""
