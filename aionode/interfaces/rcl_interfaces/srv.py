"""Services of rcl_interfaces.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated, ClassVar

from aionode.interfaces.rcl_interfaces.msg import (
    ListParametersResult,
    LoggerLevel,
    Parameter,
    ParameterDescriptor,
    ParameterValue,
    SetLoggerLevelsResult,
    SetParametersResult,
)
from aionode.message import DEFAULT, Bytes, Message, Sequence, ServiceType, uint8, uint64

__all__ = [
    "DescribeParameters",
    "GetLoggerLevels",
    "GetParameterTypes",
    "GetParameters",
    "ListParameters",
    "SetLoggerLevels",
    "SetParameters",
    "SetParametersAtomically",
]


class DescribeParameters(ServiceType, typename="rcl_interfaces/srv/DescribeParameters"):
    """A node's descriptions of its parameters."""

    class Request(Message):
        """Names of parameters."""

        names: Annotated[list[str], Sequence[str]] = DEFAULT

    class Response(Message):
        """A descriptor for each name, in order."""

        descriptors: Annotated[list[ParameterDescriptor], Sequence[ParameterDescriptor]] = DEFAULT


class GetLoggerLevels(ServiceType, typename="rcl_interfaces/srv/GetLoggerLevels"):
    """From which severity loggers write."""

    class Request(Message):
        """Names of loggers."""

        names: Annotated[list[str], Sequence[str]] = DEFAULT

    class Response(Message):
        """The level of each, in order."""

        levels: Annotated[list[LoggerLevel], Sequence[LoggerLevel]] = DEFAULT


class GetParameterTypes(ServiceType, typename="rcl_interfaces/srv/GetParameterTypes"):
    """Which types parameters of a node have."""

    class Request(Message):
        """Names of parameters."""

        names: Annotated[list[str], Sequence[str]] = DEFAULT

    class Response(Message):
        """A constant of ParameterType for each name, in order; empty if one is not declared."""

        types: Annotated[Bytes, Sequence[uint8]] = DEFAULT


class GetParameters(ServiceType, typename="rcl_interfaces/srv/GetParameters"):
    """Which values parameters of a node have."""

    class Request(Message):
        """Names of parameters."""

        names: Annotated[list[str], Sequence[str]] = DEFAULT

    class Response(Message):
        """A value for each name, in order; empty if one is not declared."""

        values: Annotated[list[ParameterValue], Sequence[ParameterValue]] = DEFAULT


class ListParameters(ServiceType, typename="rcl_interfaces/srv/ListParameters"):
    """Which parameters a node has."""

    class Request(Message):
        """Which names to list.

        Attributes:
            prefixes: List those that begin with one of these; all names if there are none.
            depth: The most parts between dots that they may have; 0 means any number.
        """

        DEPTH_RECURSIVE: ClassVar[uint64] = 0

        prefixes: Annotated[list[str], Sequence[str]] = DEFAULT
        depth: uint64 = 0

    class Response(Message):
        """The names."""

        result: ListParametersResult = DEFAULT


class SetLoggerLevels(ServiceType, typename="rcl_interfaces/srv/SetLoggerLevels"):
    """Set from which severity loggers write."""

    class Request(Message):
        """Loggers with their new level."""

        levels: Annotated[list[LoggerLevel], Sequence[LoggerLevel]] = DEFAULT

    class Response(Message):
        """The outcome for each, in order."""

        results: Annotated[list[SetLoggerLevelsResult], Sequence[SetLoggerLevelsResult]] = DEFAULT


class SetParameters(ServiceType, typename="rcl_interfaces/srv/SetParameters"):
    """Set parameters of a node, one by one."""

    class Request(Message):
        """Parameters with their new values."""

        parameters: Annotated[list[Parameter], Sequence[Parameter]] = DEFAULT

    class Response(Message):
        """The outcome for each, in order."""

        results: Annotated[list[SetParametersResult], Sequence[SetParametersResult]] = DEFAULT


class SetParametersAtomically(ServiceType, typename="rcl_interfaces/srv/SetParametersAtomically"):
    """Set parameters of a node, all or none."""

    class Request(Message):
        """Parameters with their new values."""

        parameters: Annotated[list[Parameter], Sequence[Parameter]] = DEFAULT

    class Response(Message):
        """The outcome."""

        result: SetParametersResult = DEFAULT
