"""Recordings as tests: nodes run on them in stepped time, and runs are compared."""
