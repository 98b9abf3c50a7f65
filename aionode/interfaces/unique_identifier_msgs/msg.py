"""Messages of unique_identifier_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated

from aionode.message import DEFAULT, Array, Ints, Message, uint8

__all__ = ["UUID"]


class UUID(Message, typename="unique_identifier_msgs/msg/UUID"):
    """A universally unique id, as 16 bytes; all zeros mean none."""

    uuid: Annotated[Ints, Array[uint8, 16]] = DEFAULT
