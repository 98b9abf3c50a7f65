"""std_srvs."""
