"""Messages of rosapi_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated

from aionode.message import DEFAULT, Ints, Message, Sequence, int32

__all__ = ["TypeDef"]


class TypeDef(Message, typename="rosapi_msgs/msg/TypeDef"):
    """TypeDef, as rosbridge_suite defines it."""

    type: str = ""
    fieldnames: Annotated[list[str], Sequence[str]] = DEFAULT
    fieldtypes: Annotated[list[str], Sequence[str]] = DEFAULT
    fieldarraylen: Annotated[Ints, Sequence[int32]] = DEFAULT
    examples: Annotated[list[str], Sequence[str]] = DEFAULT
    constnames: Annotated[list[str], Sequence[str]] = DEFAULT
    constvalues: Annotated[list[str], Sequence[str]] = DEFAULT
