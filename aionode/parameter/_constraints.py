"""Checks of parameters against their descriptors, with rclpy's messages."""

from __future__ import annotations

import math
from collections.abc import Callable

from aionode.interfaces.rcl_interfaces.msg import (
    FloatingPointRange,
    IntegerRange,
    ParameterDescriptor,
)
from aionode.parameter._value import Parameter, ParameterType

__all__ = ["descriptor_violation", "type_violation"]

REL_TOL = 1e-6  # tolerance for a float at a step or an end of its range


def descriptor_violation(parameter: Parameter, descriptor: ParameterDescriptor) -> str | None:
    """Return why a value is outside the descriptor's range, or None if it is inside."""
    if parameter.type_ == ParameterType.INTEGER and descriptor.integer_range:
        return integer_violation(parameter, descriptor.integer_range[0])
    if parameter.type_ == ParameterType.DOUBLE and descriptor.floating_point_range:
        return float_violation(parameter, descriptor.floating_point_range[0])
    return None


def type_violation(
    parameter: Parameter,
    descriptor: ParameterDescriptor,
    *,
    declared: bool,
    text_of: Callable[[ParameterType], str] = str,
) -> str | None:
    """Return why a value's type is not the descriptor's, or None if it is."""
    if descriptor.dynamic_typing:
        return None
    if parameter.type_ == ParameterType.NOT_SET:
        return "Static parameter cannot be undeclared" if declared else None
    if parameter.type_ == descriptor.type:
        return None
    expected = text_of(ParameterType(descriptor.type))
    return f"Wrong parameter type, expected '{expected}' got '{text_of(parameter.type_)}'"


def integer_violation(parameter: Parameter, limits: IntegerRange) -> str | None:
    """Return why an int is not in its range, or None if it is."""
    low, high = sorted((limits.from_value, limits.to_value))
    value: int = parameter.value
    if value in {low, high}:
        return None  # both ends are valid, even if no step leads to the upper one
    if not low < value < high:
        return f"Parameter {parameter.name} out of range. Min: {low}, Max: {high}, value: {value}"
    if limits.step and (value - low) % limits.step:
        return (
            f"The parameter value for {parameter.name} is not a valid step. "
            f"Min: {low}, max: {high}, value: {value}, step: {limits.step}"
        )
    return None


def float_violation(parameter: Parameter, limits: FloatingPointRange) -> str | None:
    """Return why a float is not in its range, or None if it is."""
    low, high = sorted((limits.from_value, limits.to_value))
    value: float = parameter.value
    if math.isclose(value, low, rel_tol=REL_TOL) or math.isclose(value, high, rel_tol=REL_TOL):
        return None
    if not low < value < high:
        return f"Parameter {parameter.name} out of range Min: {low}, Max: {high}, value: {value}"
    if limits.step:
        nearest = low + round((value - low) / limits.step) * limits.step
        if not math.isclose(nearest, value, rel_tol=REL_TOL):
            return (
                f"The parameter value for {parameter.name} is not close enough to a valid step. "
                f"Min: {low}, max: {high}, value: {value}, step: {limits.step}"
            )
    return None
