"""The ROS names of types, and the program's classes for them."""

from __future__ import annotations

import re
from typing import Any, Final
from weakref import WeakValueDictionary

__all__ = ["TYPES_BY_NAME", "checked_type_name"]

TYPE_NAME: Final = re.compile(r"[a-z][a-z0-9_]*/(msg|srv|action)/[A-Z][A-Za-z0-9_]*")

TYPES_BY_NAME: Final[WeakValueDictionary[str, type[Any]]] = WeakValueDictionary()
"""The newest message, service or action class of each ROS name that this program has defined.

Classes made from descriptions sent by other nodes are not included: a peer must not decide what a
name means here.
"""


def checked_type_name(name: str) -> str:
    """Return `name` if it is a valid name of a ROS type; raise `TypeError` otherwise."""
    if not TYPE_NAME.fullmatch(name):
        msg = f"{name!r}: not a valid ROS type name; write it like 'my_robot_msgs/msg/Words'"
        raise TypeError(msg)
    return name
