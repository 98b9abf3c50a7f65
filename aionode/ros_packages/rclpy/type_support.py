"""Checks of message and service classes."""

from __future__ import annotations

from typing import Any, Protocol, TypeVar

from rclpy._impl.typesupport import is_own
from rclpy.exceptions import NoTypeSupportImportedException
from rosidl_generator_py import ros_type_name

__all__ = [
    "Action",
    "FeedbackMessage",
    "GetResultServiceResponse",
    "Msg",
    "Srv",
    "check_for_type_support",
    "check_is_valid_msg_type",
    "check_is_valid_srv_type",
]

Msg = Any
Srv = Any
Action = Any
MsgT = TypeVar("MsgT")
SrvT = TypeVar("SrvT")
SrvRequestT = TypeVar("SrvRequestT")
SrvResponseT = TypeVar("SrvResponseT")
SrvEventT = TypeVar("SrvEventT")
ActionT = TypeVar("ActionT")
GoalT = TypeVar("GoalT")
ResultT = TypeVar("ResultT")
FeedbackT = TypeVar("FeedbackT")
Result_co = TypeVar("Result_co", covariant=True)
Feedback_co = TypeVar("Feedback_co", covariant=True)

MsgType = TypeVar("MsgType")
SrvType = TypeVar("SrvType")
SrvTypeRequest = TypeVar("SrvTypeRequest")
SrvTypeResponse = TypeVar("SrvTypeResponse")
"""Former names of type variables, which programs import from the modules of nodes and clients."""


class GetResultServiceResponse(Protocol[Result_co]):
    """The response to a request for the result of a goal, in annotations."""


class FeedbackMessage(Protocol[Feedback_co]):
    """The feedback of a goal, in annotations."""


def check_for_type_support(msg_or_srv_type: Any) -> None:
    """Raise unless a class is a message, service or action of either family.

    Raises:
        AttributeError: it is none of them.
        NoTypeSupportImportedException: it has no type support, and its package cannot provide it.
    """
    if is_own(msg_or_srv_type):
        return
    try:
        support = msg_or_srv_type._TYPE_SUPPORT
    except AttributeError as error:
        raise AttributeError(
            f"{error.args[0]} This might be a ROS 1 message type but it should be a ROS 2 message "
            "type. Make sure to source your ROS 2 workspace after your ROS 1 workspace."
        ) from None
    if support is None:
        msg_or_srv_type.__import_type_support__()
    if msg_or_srv_type._TYPE_SUPPORT is None:
        raise NoTypeSupportImportedException


def check_is_valid_msg_type(msg_type: Any) -> None:
    """Raise unless a class is a message.

    Raises:
        AttributeError: it is not a ROS 2 type.
        RuntimeError: it is a service or action.
    """
    check_for_type_support(msg_type)
    if hasattr(msg_type, "Request") or hasattr(msg_type, "Goal") or not ros_type_name(msg_type):
        raise RuntimeError(
            f"The message type provided is not valid ({msg_type}), this might be a service or "
            "action"
        )


def check_is_valid_srv_type(srv_type: Any) -> None:
    """Raise unless a class is a service.

    Raises:
        AttributeError: it is not a ROS 2 type.
        RuntimeError: it is a message or action.
    """
    check_for_type_support(srv_type)
    if getattr(srv_type, "Request", None) is None or getattr(srv_type, "Response", None) is None:
        raise RuntimeError(
            f"The service type provided is not valid ({srv_type}), this might be a message or "
            "action"
        )
