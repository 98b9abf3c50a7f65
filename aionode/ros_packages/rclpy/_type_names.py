"""Names that rclpy has for type checkers, and which programs import for their annotations.

None has fields, as type checkers do not see them: a program finds them when it runs.
"""

from __future__ import annotations

from collections.abc import Callable, Generator
from typing import Any, Literal, Protocol, TypedDict, TypeVar

from rclpy.qos import QoSProfile
from rclpy.type_support import Srv

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
Goal_co = TypeVar("Goal_co", covariant=True)
Result_co = TypeVar("Result_co", covariant=True)
Feedback_co = TypeVar("Feedback_co", covariant=True)

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


class SendGoalServiceRequest(Protocol[Goal_co]):
    """The request that sends a goal."""


class SendGoalServiceResponse(Protocol):
    """The answer to it."""


class GetResultServiceRequest(Protocol):
    """The request for the result of a goal."""


class GetResultServiceResponse(Protocol[Result_co]):
    """The answer to it."""


class FeedbackMessage(Protocol[Feedback_co]):
    """The feedback of a goal."""


class SendGoalKWargs(TypedDict):
    """The optional arguments of `ActionClient.send_goal_async`."""


class TimeJumpDictionary(TypedDict):
    """A jump of time, as callbacks get it."""


class TypeHashDictionary(TypedDict):
    """The parts of a type's hash."""


class CreateLifecyclePublisherArgs(TypedDict):
    """The optional arguments of `create_lifecycle_publisher`."""


class LifecycleNodeArgs(TypedDict):
    """The optional arguments of `LifecycleNode`."""
