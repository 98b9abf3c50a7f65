"""Plays bags, as they were recorded."""
