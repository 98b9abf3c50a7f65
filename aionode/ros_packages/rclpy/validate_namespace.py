"""Checks of names."""

from aionode.names import validate_namespace

__all__ = ["validate_namespace"]
