"""Interfaces of unitree_go: commands and states of the quadrupeds of Unitree."""
