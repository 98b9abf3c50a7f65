"""`launch.conditions`."""

from __future__ import annotations

from launch.condition import Condition
from launch.launch_context import LaunchContext
from launch.substitution import (
    SomeSubstitutionsType,
    normalize_to_list_of_substitutions,
    perform_substitutions,
    text_of,
)

__all__ = [
    "IfCondition",
    "InvalidConditionExpressionError",
    "LaunchConfigurationEquals",
    "LaunchConfigurationNotEquals",
    "UnlessCondition",
    "evaluate_condition_expression",
]


class InvalidConditionExpressionError(Exception):
    """A condition is neither true nor false."""


def evaluate_condition_expression(
    context: LaunchContext, expression: SomeSubstitutionsType
) -> bool:
    """Return whether a text says true or 1, and not false or 0.

    Raises:
        InvalidConditionExpressionError: It is another text.
    """
    text = text_of(context, expression)
    known = {"true": True, "1": True, "false": False, "0": False}
    try:
        return known[text.strip().lower()]
    except KeyError:
        context.need_present("a condition")  # which may concern an event
        raise InvalidConditionExpressionError(
            f"condition is {text!r}; use true, 1, false or 0"
        ) from None


class IfCondition(Condition):
    """Holds if a text evaluates to true."""

    def __init__(self, predicate_expression: SomeSubstitutionsType) -> None:
        super().__init__()
        self._IfCondition__expression = normalize_to_list_of_substitutions(predicate_expression)

    def evaluate(self, context: LaunchContext) -> bool:
        """Return whether it holds."""
        return evaluate_condition_expression(context, self._IfCondition__expression)


class UnlessCondition(IfCondition):
    """Holds if a text evaluates to false."""

    def evaluate(self, context: LaunchContext) -> bool:
        """Return whether it holds."""
        return not super().evaluate(context)


class LaunchConfigurationEquals(Condition):
    """Holds if a launch configuration has a value; None means that it does not exist."""

    def __init__(
        self, launch_configuration_name: str, expected_value: SomeSubstitutionsType | None
    ) -> None:
        super().__init__()
        self._LaunchConfigurationEquals__name = launch_configuration_name
        self._LaunchConfigurationEquals__expected = expected_value

    def evaluate(self, context: LaunchContext) -> bool:
        """Return whether it holds."""
        value = context.launch_configurations.get(self._LaunchConfigurationEquals__name)
        if self._LaunchConfigurationEquals__expected is None or value is None:
            return value is None and self._LaunchConfigurationEquals__expected is None
        expected = normalize_to_list_of_substitutions(self._LaunchConfigurationEquals__expected)
        return bool(value == perform_substitutions(context, expected))


class LaunchConfigurationNotEquals(LaunchConfigurationEquals):
    """Holds if a launch configuration has another value."""

    def evaluate(self, context: LaunchContext) -> bool:
        """Return whether it holds."""
        return not super().evaluate(context)
