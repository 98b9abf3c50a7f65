"""Interfaces of unitree_hg: commands and states of the humanoids of Unitree."""
