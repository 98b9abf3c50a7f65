"""unique_identifier_msgs."""

from typing import Annotated

from aionode.message import Array, DEFAULT, Ints, Message, uint8


class UUID(Message, typename="unique_identifier_msgs/msg/UUID"):
    """UUID."""

    uuid: Annotated[Ints, Array[uint8, 16]] = DEFAULT
