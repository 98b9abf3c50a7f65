"""Messages of rosbag2_interfaces.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from aionode.message import Message

__all__ = ["ReadSplitEvent", "WriteSplitEvent"]


class ReadSplitEvent(Message, typename="rosbag2_interfaces/msg/ReadSplitEvent"):
    """A player went on to the next file of a recording."""

    closed_file: str = ""
    opened_file: str = ""
    node_name: str = ""


class WriteSplitEvent(Message, typename="rosbag2_interfaces/msg/WriteSplitEvent"):
    """A recorder went on to its next file."""

    closed_file: str = ""
    opened_file: str = ""
    node_name: str = ""
