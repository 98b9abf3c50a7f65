"""Names that rclpy has for type checkers, and which programs import for their annotations."""

from __future__ import annotations

from collections.abc import Callable, Generator
from typing import Any, Literal, Protocol, TypedDict, TypeVar

from aionode.rclpy.clock import ClockChange
from aionode.rclpy.qos import QoSProfile
from aionode.rclpy.type_support import Srv

__all__ = [
    "CallbackNames",
    "ClientGoalHandleDict",
    "CommonMsgSrvMetaClass",
    "CreateLifecyclePublisherArgs",
    "EventHandlerData",
    "EventMessage",
    "FeedbackMessage",
    "GetResultService",
    "GetResultServiceRequest",
    "GetResultServiceResponse",
    "JumpHandlePreCallbackType",
    "LifecycleNodeArgs",
    "MsgMetaClass",
    "MsgType",
    "ProtocolType",
    "PyCapsule",
    "QoSProfileAttributes",
    "QosCallbackType",
    "SendGoalKWargs",
    "SendGoalService",
    "SendGoalServiceRequest",
    "SendGoalServiceResponse",
    "ServerGoalHandleDict",
    "SrvType",
    "SrvTypeRequest",
    "SrvTypeResponse",
    "TimeJumpDictionary",
    "TypeHashDictionary",
    "YieldedCallback",
]

MsgType = TypeVar("MsgType")
SrvType = TypeVar("SrvType")
SrvTypeRequest = TypeVar("SrvTypeRequest")
SrvTypeResponse = TypeVar("SrvTypeResponse")
Goal = TypeVar("Goal")
Result = TypeVar("Result")
Feedback = TypeVar("Feedback")

CallbackNames = Literal[
    "on_configure", "on_cleanup", "on_shutdown", "on_activate", "on_deactivate", "on_error"
]
ClientGoalHandleDict = dict[bytes, Any]
ServerGoalHandleDict = dict[bytes, Any]
EventHandlerData = Any
GetResultService = Srv
SendGoalService = Srv
JumpHandlePreCallbackType = Callable[[], None]
QosCallbackType = Callable[[QoSProfile], Any]
QoSProfileAttributes = Any
YieldedCallback = Generator[Any, None, None]
ProtocolType = type(Protocol)


class CommonMsgSrvMetaClass(ProtocolType):  # type: ignore[misc, valid-type]  # as rclpy has it
    """The common part of the classes of messages and services."""


class MsgMetaClass(CommonMsgSrvMetaClass):
    """The common part of the classes of messages."""


class PyCapsule(Protocol):
    """A pointer of the extension module."""


class EventMessage(Protocol):
    """An event of a service."""

    info: Any


class SendGoalServiceRequest(Protocol[Goal]):
    """The request that sends a goal."""

    goal_id: Any
    goal: Goal


class SendGoalServiceResponse(Protocol):
    """The answer to it."""

    accepted: bool
    stamp: Any


class GetResultServiceRequest(Protocol):
    """The request for the result of a goal."""

    goal_id: Any


class GetResultServiceResponse(Protocol[Result]):
    """The answer to it."""

    status: int
    result: Result


class FeedbackMessage(Protocol[Feedback]):
    """The feedback of a goal."""

    goal_id: Any
    feedback: Feedback


class SendGoalKWargs(TypedDict):
    """The optional arguments of `ActionClient.send_goal_async`."""

    feedback_callback: Callable[[Any], None] | None
    goal_uuid: Any


class TimeJumpDictionary(TypedDict):
    """A jump of time, as callbacks get it."""

    clock_change: ClockChange
    delta: int


class TypeHashDictionary(TypedDict):
    """The parts of a type's hash."""

    version: int
    value: bytes


class CreateLifecyclePublisherArgs(TypedDict, total=False):
    """The optional arguments of `create_lifecycle_publisher`."""

    callback_group: Any
    event_callbacks: Any
    qos_overriding_options: Any


class LifecycleNodeArgs(TypedDict, total=False):
    """The optional arguments of `LifecycleNode`."""

    context: Any
    cli_args: list[str] | None
    namespace: str | None
    use_global_arguments: bool
    enable_rosout: bool
    start_parameter_services: bool
    parameter_overrides: list[Any] | None
    allow_undeclared_parameters: bool
    automatically_declare_parameters_from_overrides: bool
    enable_logger_service: bool
