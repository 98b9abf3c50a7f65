"""rosgraph_msgs."""

from aionode.interfaces.builtin_interfaces.msg import Time
from aionode.message import DEFAULT, Message


class Clock(Message, typename="rosgraph_msgs/msg/Clock"):
    """Clock."""

    clock: Time = DEFAULT
