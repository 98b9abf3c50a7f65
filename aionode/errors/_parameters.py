"""Errors about parameters and their files."""

from __future__ import annotations

from aionode.errors._base import AionodeError

__all__ = [
    "InvalidParameterException",
    "InvalidParameterTypeException",
    "InvalidParameterValueException",
    "ParameterAlreadyDeclaredException",
    "ParameterException",
    "ParameterFileError",
    "ParameterImmutableException",
    "ParameterNotDeclaredException",
    "ParameterUninitializedException",
]


class ParameterFileError(AionodeError, ValueError, RuntimeError):
    """A parameter file or a parameter value in YAML cannot be read.

    Attributes:
        source: Path of the file, or another description of what was read.
        line: Line number, from 1; 0 if it is not known.
        problem: What is wrong.
    """

    def __init__(self, source: str, line: int, problem: str) -> None:
        self.source = source
        self.line = line
        self.problem = problem
        where = f"{source}, line {line}" if line else source
        super().__init__(f"{where}: {problem}")


class ParameterException(AionodeError):
    """Base of the errors about parameters.

    Attributes:
        parameters: Name of the parameter, or a list of names.
    """

    def __init__(self, error_msg: str, parameters: str | list[str]) -> None:
        self.error_msg = error_msg
        self.parameters = parameters
        super().__init__(f"{error_msg}: {parameters}")

    def __str__(self) -> str:
        # KeyError, a base of one of the subclasses, would put the text in quotes.
        return str(self.args[0])


class ParameterNotDeclaredException(ParameterException, KeyError):
    """An undeclared parameter was used where the node does not allow it."""

    def __init__(self, parameters: str | list[str]) -> None:
        super().__init__("Invalid access to undeclared parameter(s)", parameters)


class ParameterAlreadyDeclaredException(ParameterException, ValueError):
    """A parameter was declared twice."""

    def __init__(self, parameters: str | list[str]) -> None:
        super().__init__("Parameter(s) already declared", parameters)


class InvalidParameterException(ParameterException, ValueError):
    """A parameter was declared with an invalid name."""

    def __init__(self, parameter_name: str) -> None:
        super().__init__("Invalid parameter name", parameter_name)


class InvalidParameterTypeException(ParameterException, TypeError):
    """A value does not have the declared type of the parameter.

    Attributes:
        name: Name of the parameter.
        value: The rejected value.
        type_name: Name of the value's type.
        expected_type: Name of the declared type.
    """

    def __init__(self, name: str, value: object, type_name: str, expected_type: str) -> None:
        self.name = name
        self.value = value
        self.type_name = type_name
        self.expected_type = expected_type
        hint = f" (write {value}.0)" if (type_name, expected_type) == ("INTEGER", "DOUBLE") else ""
        super().__init__(
            f"Trying to set parameter '{name}' to '{value}' of type '{type_name}', "
            f"expecting type '{expected_type}'{hint}",
            name,
        )


class InvalidParameterValueException(ParameterException, ValueError):
    """A value was rejected by the parameter's descriptor or by a callback.

    Attributes:
        name: Name of the parameter.
        value: The rejected value.
        reason: Why it was rejected.
    """

    def __init__(self, name: str, value: object, reason: str) -> None:
        self.name = name
        self.value = value
        self.reason = reason
        super().__init__(f"Invalid parameter value ({value}) for parameter. Reason: {reason}", name)


class ParameterImmutableException(ParameterException, RuntimeError):
    """A read-only parameter cannot be undeclared."""

    def __init__(self, parameter_name: str) -> None:
        super().__init__("Attempted to modify read-only parameter", parameter_name)


class ParameterUninitializedException(ParameterException, RuntimeError):
    """A parameter declared without a value was read before it had one."""

    def __init__(self, parameter_name: str) -> None:
        super().__init__(f"The parameter '{parameter_name}' is not initialized", parameter_name)
