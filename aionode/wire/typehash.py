"""RIHS01 hashes: whether two nodes mean the same by the name of a type.

A hash stands in the keys of topics and services, so only endpoints of equal hashes hear each other.
"""

from __future__ import annotations

import hashlib
import json
from functools import cache
from typing import Any

from aionode.wire._type_description import describe

__all__ = ["type_hash"]


@cache
def type_hash(cls: type[Any]) -> str:
    """Return the hash of a message, service or action class: ``RIHS01_`` and 64 hex digits.

    Constants, comments and default values do not count. Requests, responses and the other parts of
    services and actions have hashes of their own.

    Raises:
        TypeError: `cls` is no such class.
    """
    # The form of json.dumps, order of keys and blanks included, is the one that ROS 2 hashes.
    text = json.dumps(describe(cls))
    return "RIHS01_" + hashlib.sha256(text.encode()).hexdigest()
