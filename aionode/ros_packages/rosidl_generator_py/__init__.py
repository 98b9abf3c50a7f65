"""Message, service and action classes as rosidl generates them, made at run time."""

from __future__ import annotations

from rosidl_generator_py._codec import decode, decoder_of, encode, from_aionode, to_aionode
from rosidl_generator_py._names import (
    action_class,
    aionode_class,
    classes_of,
    interface_class,
    message_class,
    ros_type_name,
    service_class,
)

__all__ = [
    "action_class",
    "aionode_class",
    "classes_of",
    "decode",
    "decoder_of",
    "encode",
    "from_aionode",
    "interface_class",
    "message_class",
    "ros_type_name",
    "service_class",
    "to_aionode",
]
