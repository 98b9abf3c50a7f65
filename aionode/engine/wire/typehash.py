"""RIHS01 type hashes, which identify the definition of a type.

They are part of the keys of topics and services: only endpoints with equal hashes communicate.
"""

from __future__ import annotations

import hashlib
from functools import cache
from typing import Any

import msgspec

from aionode.engine.wire._type_description import describe, description_message, referenced_types
from aionode.message import unserialized

__all__ = ["description_message", "referenced_types", "type_hash"]


@cache
def type_hash(cls: type[Any]) -> str:
    """Return the hash of a message, service or action class: ``RIHS01_`` and 64 hex digits.

    Constants, comments and default values do not affect it. Requests, responses and the other parts
    of services and actions have hashes of their own.

    Raises:
        TypeError: `cls` is not such a class.
    """
    # ROS 2 hashes exactly the output of json.dumps, including the key order and spaces.
    compact = msgspec.json.encode(describe(unserialized(cls)))
    return "RIHS01_" + hashlib.sha256(msgspec.json.format(compact, indent=0)).hexdigest()
