"""Message, service and action classes as rosidl generates them, made at run time."""

from __future__ import annotations

from aionode.rclpy._rosidl._codec import decode, encode, from_aionode, to_aionode
from aionode.rclpy._rosidl._names import (
    action_class,
    aionode_class,
    interface_class,
    message_class,
    ros_type_name,
    service_class,
)

__all__ = [
    "action_class",
    "aionode_class",
    "decode",
    "encode",
    "from_aionode",
    "interface_class",
    "message_class",
    "ros_type_name",
    "service_class",
    "to_aionode",
]
