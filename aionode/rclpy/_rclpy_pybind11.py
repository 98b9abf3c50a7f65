"""The names of rclpy's extension module that programs use.

The handles do what those of the extension do; functions that only rclpy itself calls are left out.
"""

from __future__ import annotations

from typing import Any

from aionode.arguments import remove_ros_args
from aionode.clock import ClockChange, ClockType
from aionode.rclpy._impl.actions import ActionClientHandle as ActionClient
from aionode.rclpy._impl.actions import ActionServerHandle as ActionServer
from aionode.rclpy._impl.actions import GoalEvent
from aionode.rclpy._impl.context import ContextHandle as Context
from aionode.rclpy._impl.destroyable import Destroyable
from aionode.rclpy._impl.errors import (
    InvalidHandle,
    NodeNameNonExistentError,
    RCLError,
    RCLInvalidROSArgsError,
    TimerCancelledError,
    UnknownROSArgsError,
    UnsupportedEventTypeError,
)
from aionode.rclpy._impl.events import EventHandle
from aionode.rclpy._impl.node import NodeHandle as Node
from aionode.rclpy._impl.qos import rmw_qos_profile_t
from aionode.rclpy._impl.services import ClientHandle as Client
from aionode.rclpy._impl.services import ServiceHandle as Service
from aionode.rclpy._impl.services import rmw_request_id_t, rmw_service_info_t
from aionode.rclpy._impl.timers import ClockHandle as Clock
from aionode.rclpy._impl.timers import GuardConditionHandle as GuardCondition
from aionode.rclpy._impl.timers import TimerHandle as Timer
from aionode.rclpy._impl.topics import PublisherHandle as Publisher
from aionode.rclpy._impl.topics import SubscriptionHandle as Subscription
from aionode.rclpy._impl.typesupport import message_support
from aionode.rclpy._impl.wait_set import WaitSet
from aionode.rclpy.signals import SignalHandlerOptions

__all__ = [
    "RCL_DEFAULT_DOMAIN_ID",
    "ActionClient",
    "ActionServer",
    "Client",
    "Clock",
    "ClockChange",
    "ClockType",
    "Context",
    "Destroyable",
    "EventHandle",
    "GoalEvent",
    "GuardCondition",
    "InvalidHandle",
    "Node",
    "NodeNameNonExistentError",
    "Publisher",
    "RCLError",
    "RCLInvalidROSArgsError",
    "Service",
    "SignalHandlerOptions",
    "Subscription",
    "Timer",
    "TimerCancelledError",
    "UnknownROSArgsError",
    "UnsupportedEventTypeError",
    "WaitSet",
    "rclpy_deserialize",
    "rclpy_get_rmw_implementation_identifier",
    "rclpy_remove_ros_args",
    "rclpy_serialize",
    "rmw_qos_profile_t",
    "rmw_request_id_t",
    "rmw_service_info_t",
]

RCL_DEFAULT_DOMAIN_ID = None

rclpy_remove_ros_args = remove_ros_args


def rclpy_get_rmw_implementation_identifier() -> str:
    """Return the middleware whose format is used on the wire."""
    return "rmw_zenoh_cpp"


def rclpy_serialize(message: Any, message_type: Any) -> bytes:
    """Return a message as bytes (CDR)."""
    return message_support(message_type).encode(message)


def rclpy_deserialize(data: bytes, message_type: Any) -> Any:
    """Return the message in bytes (CDR)."""
    return message_support(message_type).decode(data)
