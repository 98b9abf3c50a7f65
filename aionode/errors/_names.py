"""Errors about names, and about the arguments that a program is started with."""

from __future__ import annotations

from aionode.errors._base import MAX_NAME, AionodeError

__all__ = [
    "InvalidLogLevelError",
    "InvalidNamespaceException",
    "InvalidNodeNameException",
    "InvalidROSArgsError",
    "InvalidRemapRuleError",
    "InvalidServiceNameException",
    "InvalidTopicNameException",
    "NameValidationException",
    "UnknownROSArgsError",
]


class NameValidationException(AionodeError, ValueError):
    """A name of a topic, service, namespace or node breaks the rules for names.

    Attributes:
        name: The name as given.
        error_msg: The rule that it breaks.
        invalid_index: Index into `name` of the first invalid character.
    """

    def __init__(self, name_type: str, name: str, error_msg: str, invalid_index: int) -> None:
        self.name_type = name_type
        self.name = name
        self.error_msg = error_msg
        self.invalid_index = invalid_index
        # Show only the surroundings of the mistake in a long name.
        begin = max(0, min(invalid_index, len(name)) - MAX_NAME // 2)
        before = "…" if begin else ""
        after = "…" if begin + MAX_NAME < len(name) else ""
        shown = f"{before}{name[begin : begin + MAX_NAME]}{after}"
        caret = " " * (invalid_index - begin + len(before)) + "^"
        super().__init__(f"Invalid {name_type}: {error_msg}:\n  '{shown}'\n   {caret}")


class InvalidTopicNameException(NameValidationException):
    """A topic name breaks the rules for names."""

    def __init__(self, name: str, error_msg: str, invalid_index: int) -> None:
        super().__init__("topic name", name, error_msg, invalid_index)


class InvalidServiceNameException(NameValidationException):
    """A service name breaks the rules for names."""

    def __init__(self, name: str, error_msg: str, invalid_index: int) -> None:
        super().__init__("service name", name, error_msg, invalid_index)


class InvalidNamespaceException(NameValidationException):
    """A namespace breaks the rules for names."""

    def __init__(self, name: str, error_msg: str, invalid_index: int) -> None:
        super().__init__("namespace", name, error_msg, invalid_index)


class InvalidNodeNameException(NameValidationException):
    """A node name breaks the rules for names."""

    def __init__(self, name: str, error_msg: str, invalid_index: int) -> None:
        super().__init__("node name", name, error_msg, invalid_index)


class InvalidRemapRuleError(AionodeError, ValueError):
    """A remapping rule cannot be read.

    Attributes:
        rule: The rule as given.
        problem: What is wrong.
    """

    def __init__(self, rule: str, problem: str) -> None:
        self.rule = rule
        self.problem = problem
        super().__init__(f"remap rule '{rule}': {problem}")


class InvalidROSArgsError(AionodeError, ValueError):
    """A known ``--ros-args`` flag has an invalid value.

    Attributes:
        argument: The argument or arguments at fault, as given.
        problem: What is wrong and what would be valid.
    """

    def __init__(self, argument: str, problem: str) -> None:
        self.argument = argument
        self.problem = problem
        super().__init__(f"--ros-args: '{argument}': {problem}")


class UnknownROSArgsError(InvalidROSArgsError):
    """There is an unknown argument between ``--ros-args`` and ``--``.

    Attributes:
        unknown_ros_args: All unknown arguments.
    """

    def __init__(self, unknown_ros_args: list[str], problem: str) -> None:
        self.unknown_ros_args = list(unknown_ros_args)
        super().__init__(" ".join(unknown_ros_args), problem)


class InvalidLogLevelError(AionodeError, ValueError, RuntimeError):
    """A log level does not exist; a RuntimeError as in rclpy.

    Attributes:
        level: The name that was given.
        fits: The names of all log levels.
    """

    def __init__(self, level: str, fits: list[str]) -> None:
        self.level = level
        self.fits = fits
        super().__init__(f"unknown log level '{level}'; valid levels are {', '.join(fits)}")
