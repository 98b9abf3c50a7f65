"""`launch.logging`."""

from __future__ import annotations

import logging

__all__ = ["get_logger"]


def get_logger(name: str | None = None) -> logging.Logger:
    """Return a logger of Python's library, below ``launch``."""
    return logging.getLogger(f"launch.{name}" if name else "launch")
