"""Interfaces of std_srvs: services without a type of their own."""
