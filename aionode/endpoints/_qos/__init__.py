"""Deadline, lifespan and liveliness kept, and the events of publishers and subscriptions."""
