"""Joysticks: what reads them, and what drives a base by them."""
