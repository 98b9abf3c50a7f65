"""Loggers."""

from aionode.logging import RcutilsLogger

__all__ = ["RcutilsLogger"]
