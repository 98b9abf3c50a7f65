"""Stands in for the message classes as rosidl makes them: aionode's own."""

from __future__ import annotations

import importlib
from typing import Any

from aionode.message import type_name
from aionode.wire import cdr

__all__ = [
    "action_class",
    "aionode_class",
    "decode",
    "encode",
    "message_class",
    "ros_type_name",
    "service_class",
]


def message_class(name: str) -> Any:
    package, kind, short = name.split("/")
    return getattr(importlib.import_module(f"aionode.interfaces.{package}.{kind}"), short)


service_class = action_class = message_class
ros_type_name = type_name


def encode(msg: Any) -> bytes:
    return cdr.encode(msg)


def decode(cls: Any, data: bytes) -> Any:
    return cdr.decode(cls, data)


def aionode_class(cls: Any) -> Any:
    return cls
