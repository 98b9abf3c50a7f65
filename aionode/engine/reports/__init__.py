"""Warnings about the graph: duplicate node names, and endpoints that do not match."""
