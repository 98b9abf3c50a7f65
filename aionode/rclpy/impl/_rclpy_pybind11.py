"""The names of rclpy's extension module that programs use.

The handles do what those of the extension do; functions that only rclpy itself calls are left out.
"""

from __future__ import annotations

from typing import Any

from aionode.arguments import remove_ros_args
from aionode.clock import ClockChange, ClockType
from aionode.errors import NodeNameNonExistentError
from aionode.rclpy.impl._context import ContextHandle as Context
from aionode.rclpy.impl._destroyable import Destroyable
from aionode.rclpy.impl._errors import (
    InvalidHandle,
    RCLError,
    RCLInvalidROSArgsError,
    TimerCancelledError,
    UnknownROSArgsError,
    UnsupportedEventTypeError,
)
from aionode.rclpy.impl._events import EventHandle
from aionode.rclpy.impl._node import NodeHandle as Node
from aionode.rclpy.impl._qos import rmw_qos_profile_t
from aionode.rclpy.impl._services import ClientHandle as Client
from aionode.rclpy.impl._services import ServiceHandle as Service
from aionode.rclpy.impl._services import rmw_request_id_t, rmw_service_info_t
from aionode.rclpy.impl._signals import SignalHandlerOptions
from aionode.rclpy.impl._timers import ClockHandle as Clock
from aionode.rclpy.impl._timers import GuardConditionHandle as GuardCondition
from aionode.rclpy.impl._timers import TimerHandle as Timer
from aionode.rclpy.impl._topics import PublisherHandle as Publisher
from aionode.rclpy.impl._topics import SubscriptionHandle as Subscription
from aionode.rclpy.impl._typesupport import message_support
from aionode.rclpy.impl._wait_set import WaitSet

__all__ = [
    "RCL_DEFAULT_DOMAIN_ID",
    "Client",
    "Clock",
    "ClockChange",
    "ClockType",
    "Context",
    "Destroyable",
    "EventHandle",
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
