"""rcl_interfaces."""

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
from aionode.message import Bytes, DEFAULT, Message, Sequence, ServiceType, uint64, uint8


class DescribeParameters(ServiceType, typename="rcl_interfaces/srv/DescribeParameters"):
    """DescribeParameters."""

    class Request(Message):
        """Request."""

        names: Annotated[list[str], Sequence[str]] = DEFAULT

    class Response(Message):
        """Response."""

        descriptors: Annotated[list[ParameterDescriptor], Sequence[ParameterDescriptor]] = DEFAULT


class GetLoggerLevels(ServiceType, typename="rcl_interfaces/srv/GetLoggerLevels"):
    """GetLoggerLevels."""

    class Request(Message):
        """Request."""

        names: Annotated[list[str], Sequence[str]] = DEFAULT

    class Response(Message):
        """Response."""

        levels: Annotated[list[LoggerLevel], Sequence[LoggerLevel]] = DEFAULT


class GetParameterTypes(ServiceType, typename="rcl_interfaces/srv/GetParameterTypes"):
    """GetParameterTypes."""

    class Request(Message):
        """Request."""

        names: Annotated[list[str], Sequence[str]] = DEFAULT

    class Response(Message):
        """Response."""

        types: Annotated[Bytes, Sequence[uint8]] = DEFAULT


class GetParameters(ServiceType, typename="rcl_interfaces/srv/GetParameters"):
    """GetParameters."""

    class Request(Message):
        """Request."""

        names: Annotated[list[str], Sequence[str]] = DEFAULT

    class Response(Message):
        """Response."""

        values: Annotated[list[ParameterValue], Sequence[ParameterValue]] = DEFAULT


class ListParameters(ServiceType, typename="rcl_interfaces/srv/ListParameters"):
    """ListParameters."""

    class Request(Message):
        """Request."""

        DEPTH_RECURSIVE: ClassVar[uint64] = 0
        prefixes: Annotated[list[str], Sequence[str]] = DEFAULT
        depth: uint64 = 0

    class Response(Message):
        """Response."""

        result: ListParametersResult = DEFAULT


class SetLoggerLevels(ServiceType, typename="rcl_interfaces/srv/SetLoggerLevels"):
    """SetLoggerLevels."""

    class Request(Message):
        """Request."""

        levels: Annotated[list[LoggerLevel], Sequence[LoggerLevel]] = DEFAULT

    class Response(Message):
        """Response."""

        results: Annotated[list[SetLoggerLevelsResult], Sequence[SetLoggerLevelsResult]] = DEFAULT


class SetParameters(ServiceType, typename="rcl_interfaces/srv/SetParameters"):
    """SetParameters."""

    class Request(Message):
        """Request."""

        parameters: Annotated[list[Parameter], Sequence[Parameter]] = DEFAULT

    class Response(Message):
        """Response."""

        results: Annotated[list[SetParametersResult], Sequence[SetParametersResult]] = DEFAULT


class SetParametersAtomically(ServiceType, typename="rcl_interfaces/srv/SetParametersAtomically"):
    """SetParametersAtomically."""

    class Request(Message):
        """Request."""

        parameters: Annotated[list[Parameter], Sequence[Parameter]] = DEFAULT

    class Response(Message):
        """Response."""

        result: SetParametersResult = DEFAULT
