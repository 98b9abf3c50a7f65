"""Message, service and action classes as rosidl generates them, made at run time."""

from __future__ import annotations

from aionode.rclpy._rosidl._classes import module_name
from aionode.rclpy._rosidl._codec import decode, decoder_of, encode, from_aionode, to_aionode
from aionode.rclpy._rosidl._names import (
    action_class,
    aionode_class,
    classes_of,
    interface_class,
    message_class,
    ros_type_name,
    service_class,
)
from aionode.rclpy._rosidl._search import add_folder, has_interfaces, names_in

__all__ = [
    "action_class",
    "add_folder",
    "aionode_class",
    "classes_of",
    "decode",
    "decoder_of",
    "encode",
    "from_aionode",
    "has_interfaces",
    "interface_class",
    "message_class",
    "module_name",
    "names_in",
    "ros_type_name",
    "service_class",
    "to_aionode",
]
