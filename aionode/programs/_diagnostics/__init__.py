"""Diagnostics: the states of many parts of a robot, aggregated."""
