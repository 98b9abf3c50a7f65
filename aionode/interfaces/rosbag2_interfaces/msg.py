"""Messages of rosbag2_interfaces.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated

from aionode.message import DEFAULT, Message, Sequence, uint64

__all__ = ["MessagesLostEvent", "MessagesLostEventTopicStat", "ReadSplitEvent", "WriteSplitEvent"]


class MessagesLostEventTopicStat(
    Message, typename="rosbag2_interfaces/msg/MessagesLostEventTopicStat"
):
    """How many messages of one topic were lost since the last event.

    Attributes:
        messages_lost_in_transport: How many did not arrive at the recorder.
        messages_lost_in_recorder: How many arrived and were not written.
    """

    topic_name: str = ""
    messages_lost_in_transport: uint64 = 0
    messages_lost_in_recorder: uint64 = 0


class MessagesLostEvent(Message, typename="rosbag2_interfaces/msg/MessagesLostEvent"):
    """A recorder has lost messages; the losses by topic."""

    node_name: str = ""
    messages_lost_statistics: Annotated[
        list[MessagesLostEventTopicStat], Sequence[MessagesLostEventTopicStat]
    ] = DEFAULT


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
