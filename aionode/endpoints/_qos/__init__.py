"""Enforcement of deadline, lifespan and liveliness, and the events of endpoints."""
