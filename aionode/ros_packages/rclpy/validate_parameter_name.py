"""Checks of names."""

from aionode.parameter import validate_parameter_name

__all__ = ["validate_parameter_name"]
