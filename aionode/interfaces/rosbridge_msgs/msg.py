"""Messages of rosbridge_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated

from aionode.interfaces.builtin_interfaces.msg import Time
from aionode.message import DEFAULT, Message, Sequence

__all__ = ["ConnectedClient", "ConnectedClients"]


class ConnectedClient(Message, typename="rosbridge_msgs/msg/ConnectedClient"):
    """ConnectedClient, as rosbridge_suite defines it."""

    ip_address: str = ""
    connection_time: Time = DEFAULT


class ConnectedClients(Message, typename="rosbridge_msgs/msg/ConnectedClients"):
    """ConnectedClients, as rosbridge_suite defines it."""

    clients: Annotated[list[ConnectedClient], Sequence[ConnectedClient]] = DEFAULT
