"""The validators that descriptions of parameters name."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

__all__ = ["ParameterValidators"]


def compared(param: Any, fits: bool, what: str, value: Any) -> str:
    """Return the error text of a parameter for which a comparison fails; empty if it holds."""
    how = f"with the value {param.value} must be {what} {value}"
    return "" if fits else f"Parameter '{param.name}' {how}"


def measured(param: Any, fits: bool, what: str, length: int) -> str:
    """Return the error text of a parameter of a wrong length; empty if it is right."""
    how = f"is '{len(param.value)}' but must be {what} {length}"
    return "" if fits else f"Length of parameter '{param.name}' {how}"


class ParameterValidators:
    """Functions that return what is wrong with a parameter; an empty text if nothing is."""

    @staticmethod
    def lt(param: Any, value: Any) -> str:
        """Check that a number is less than a value."""
        return compared(param, param.value < value, "less than", value)

    @staticmethod
    def gt(param: Any, value: Any) -> str:
        """Check that a number is greater than a value."""
        return compared(param, param.value > value, "greater than", value)

    @staticmethod
    def lt_eq(param: Any, value: Any) -> str:
        """Check that a number is at most a value."""
        return compared(param, param.value <= value, "below upper bound of", value)

    @staticmethod
    def gt_eq(param: Any, value: Any) -> str:
        """Check that a number is at least a value."""
        return compared(param, param.value >= value, "above lower bound of", value)

    @staticmethod
    def not_empty(param: Any) -> str:
        """Check that a text or array is not empty."""
        return "" if len(param.value) else f"Parameter '{param.name}' cannot be empty"

    @staticmethod
    def one_of(param: Any, values: Sequence[Any]) -> str:
        """Check that a value is in a set."""
        if param.value in values:
            return ""
        how = f"with the value '{param.value}' is not in the set {values}"
        return f"Parameter '{param.name}' {how}"

    @staticmethod
    def unique(param: Any) -> str:
        """Check that no entry occurs twice."""
        if len(set(param.value)) == len(param.value):
            return ""
        return f"Parameter '{param.name}' must only contain unique values"

    @staticmethod
    def subset_of(param: Any, values: Sequence[Any]) -> str:
        """Check that each entry is in a set."""
        for value in param.value:
            if value not in values:
                return f"Entry '{value}' in parameter '{param.name}' is not in the set {values}"
        return ""

    @staticmethod
    def fixed_size(param: Any, length: int) -> str:
        """Check that a text or array has a length."""
        return measured(param, len(param.value) == length, "equal to", length)

    @staticmethod
    def size_gt(param: Any, length: int) -> str:
        """Check that a text or array is longer than a length."""
        return measured(param, len(param.value) > length, "greater than", length)

    @staticmethod
    def size_lt(param: Any, length: int) -> str:
        """Check that a text or array is shorter than a length."""
        return measured(param, len(param.value) < length, "less than", length)

    @staticmethod
    def element_bounds(param: Any, lower: Any, upper: Any) -> str:
        """Check that each number is within bounds."""
        if all(lower <= value <= upper for value in param.value):
            return ""
        where = f"must be within bounds [{lower}, {upper}]"
        return f"Value {param.value} in parameter '{param.name}' {where}"

    @staticmethod
    def lower_element_bounds(param: Any, lower: Any) -> str:
        """Check that each number is at least a value."""
        for value in param.value:
            if value < lower:
                where = f"must be above lower bound of {lower}"
                return f"Value {value} in parameter '{param.name}' {where}"
        return ""

    @staticmethod
    def upper_element_bounds(param: Any, upper: Any) -> str:
        """Check that each number is at most a value."""
        for value in param.value:
            if value > upper:
                where = f"must be below upper bound of {upper}"
                return f"Value {value} in parameter '{param.name}' {where}"
        return ""

    @staticmethod
    def bounds(param: Any, lower: Any, upper: Any) -> str:
        """Check that a number is within bounds."""
        if lower <= param.value <= upper:
            return ""
        where = f"must be within bounds [{lower}, {upper}]"
        return f"Value {param.value} in parameter '{param.name}' {where}"
