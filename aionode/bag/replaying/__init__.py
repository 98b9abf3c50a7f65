"""Recordings as tests: run nodes on them in stepped time, and compare the outputs."""
