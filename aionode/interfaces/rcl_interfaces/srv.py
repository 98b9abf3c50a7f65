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
    """DescribeParameters."""

    class Request(Message):
        """The request of DescribeParameters."""

        names: Annotated[list[str], Sequence[str]] = DEFAULT

    class Response(Message):
        """The response of DescribeParameters."""

        descriptors: Annotated[list[ParameterDescriptor], Sequence[ParameterDescriptor]] = DEFAULT


class GetLoggerLevels(ServiceType, typename="rcl_interfaces/srv/GetLoggerLevels"):
    """GetLoggerLevels."""

    class Request(Message):
        """The request of GetLoggerLevels."""

        names: Annotated[list[str], Sequence[str]] = DEFAULT

    class Response(Message):
        """The response of GetLoggerLevels."""

        levels: Annotated[list[LoggerLevel], Sequence[LoggerLevel]] = DEFAULT


class GetParameterTypes(ServiceType, typename="rcl_interfaces/srv/GetParameterTypes"):
    """GetParameterTypes."""

    class Request(Message):
        """The request of GetParameterTypes."""

        names: Annotated[list[str], Sequence[str]] = DEFAULT

    class Response(Message):
        """The response of GetParameterTypes."""

        types: Annotated[Bytes, Sequence[uint8]] = DEFAULT


class GetParameters(ServiceType, typename="rcl_interfaces/srv/GetParameters"):
    """GetParameters."""

    class Request(Message):
        """The request of GetParameters."""

        names: Annotated[list[str], Sequence[str]] = DEFAULT

    class Response(Message):
        """The response of GetParameters."""

        values: Annotated[list[ParameterValue], Sequence[ParameterValue]] = DEFAULT


class ListParameters(ServiceType, typename="rcl_interfaces/srv/ListParameters"):
    """ListParameters."""

    class Request(Message):
        """The request of ListParameters."""

        DEPTH_RECURSIVE: ClassVar[uint64] = 0

        prefixes: Annotated[list[str], Sequence[str]] = DEFAULT
        depth: uint64 = 0

    class Response(Message):
        """The response of ListParameters."""

        result: ListParametersResult = DEFAULT


class SetLoggerLevels(ServiceType, typename="rcl_interfaces/srv/SetLoggerLevels"):
    """SetLoggerLevels."""

    class Request(Message):
        """The request of SetLoggerLevels."""

        levels: Annotated[list[LoggerLevel], Sequence[LoggerLevel]] = DEFAULT

    class Response(Message):
        """The response of SetLoggerLevels."""

        results: Annotated[list[SetLoggerLevelsResult], Sequence[SetLoggerLevelsResult]] = DEFAULT


class SetParameters(ServiceType, typename="rcl_interfaces/srv/SetParameters"):
    """SetParameters."""

    class Request(Message):
        """The request of SetParameters."""

        parameters: Annotated[list[Parameter], Sequence[Parameter]] = DEFAULT

    class Response(Message):
        """The response of SetParameters."""

        results: Annotated[list[SetParametersResult], Sequence[SetParametersResult]] = DEFAULT


class SetParametersAtomically(ServiceType, typename="rcl_interfaces/srv/SetParametersAtomically"):
    """SetParametersAtomically."""

    class Request(Message):
        """The request of SetParametersAtomically."""

        parameters: Annotated[list[Parameter], Sequence[Parameter]] = DEFAULT

    class Response(Message):
        """The response of SetParametersAtomically."""

        result: SetParametersResult = DEFAULT
