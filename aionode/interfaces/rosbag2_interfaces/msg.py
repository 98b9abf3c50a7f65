"""rosbag2_interfaces."""

from aionode.message import Message


class ReadSplitEvent(Message, typename="rosbag2_interfaces/msg/ReadSplitEvent"):
    """ReadSplitEvent."""

    closed_file: str = ""
    opened_file: str = ""
    node_name: str = ""


class WriteSplitEvent(Message, typename="rosbag2_interfaces/msg/WriteSplitEvent"):
    """WriteSplitEvent."""

    closed_file: str = ""
    opened_file: str = ""
    node_name: str = ""
