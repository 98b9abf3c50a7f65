"""Joysticks: a node that reads one, and a node that drives a base with it."""
