"""The session of one client, and what clients share."""
