"""Messages of rosgraph_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from aionode.interfaces.builtin_interfaces.msg import Time
from aionode.message import DEFAULT, Message

__all__ = ["Clock"]


class Clock(Message, typename="rosgraph_msgs/msg/Clock"):
    """The time of a simulation or a played recording, for nodes with ``use_sim_time``."""

    clock: Time = DEFAULT
