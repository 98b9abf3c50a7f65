"""The names of rclpy's extension module that programs use.

The handles work like those of the extension; functions that only rclpy itself calls are left out.
"""

from __future__ import annotations

from typing import Any

from aionode.arguments import remove_ros_args
from aionode.clock import ClockChange, ClockType
from rclpy._impl.actions import ActionClientHandle as ActionClient
from rclpy._impl.actions import ActionServerHandle as ActionServer
from rclpy._impl.actions import GoalEvent
from rclpy._impl.context import ContextHandle as Context
from rclpy._impl.destroyable import Destroyable
from rclpy._impl.errors import (
    InvalidHandle,
    NodeNameNonExistentError,
    RCLError,
    RCLInvalidROSArgsError,
    RMWError,
    TimerCancelledError,
    UnknownROSArgsError,
    UnsupportedEventTypeError,
)
from rclpy._impl.events import EventHandle
from rclpy._impl.node import NodeHandle as Node
from rclpy._impl.qos import rmw_qos_profile_t
from rclpy._impl.services import ClientHandle as Client
from rclpy._impl.services import ServiceHandle as Service
from rclpy._impl.services import rmw_request_id_t, rmw_service_info_t
from rclpy._impl.timers import ClockHandle as Clock
from rclpy._impl.timers import GuardConditionHandle as GuardCondition
from rclpy._impl.timers import TimerHandle as Timer
from rclpy._impl.topics import PublisherHandle as Publisher
from rclpy._impl.topics import SubscriptionHandle as Subscription
from rclpy._impl.typesupport import deserialized, message_support
from rclpy._impl.wait_set import WaitSet
from rclpy.signals import SignalHandlerOptions

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
    "RMWError",
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
    """Return the middleware whose wire format is used."""
    return "rmw_zenoh_cpp"


def rclpy_serialize(message: Any, message_type: Any) -> bytes:
    """Return a message as bytes (CDR)."""
    return message_support(message_type).encode(message)


def rclpy_deserialize(data: bytes, message_type: Any) -> Any:
    """Decode a message from bytes (CDR)."""
    return deserialized(data, message_type)
