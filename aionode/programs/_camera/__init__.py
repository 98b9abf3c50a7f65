"""Cameras, and other forms of their images."""
