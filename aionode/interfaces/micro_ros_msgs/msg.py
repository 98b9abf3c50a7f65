"""Messages of micro_ros_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated, ClassVar

from aionode.message import DEFAULT, Bounded, Message, Sequence, byte

__all__ = ["Entity", "Graph", "Node"]


class Entity(Message, typename="micro_ros_msgs/msg/Entity"):
    """Entity, as micro-ROS defines it."""

    PUBLISHER: ClassVar[byte] = b"\x00"
    SUBSCRIBER: ClassVar[byte] = b"\x01"
    SERVICE_SERVER: ClassVar[byte] = b"\x02"
    SERVICE_CLIENT: ClassVar[byte] = b"\x03"

    entity_type: byte = b"\x00"
    name: Bounded[str, 256] = ""
    types: Annotated[list[str], Sequence[Bounded[str, 256]]] = DEFAULT


class Node(Message, typename="micro_ros_msgs/msg/Node"):
    """Node, as micro-ROS defines it."""

    node_namespace: Bounded[str, 256] = ""
    node_name: Bounded[str, 256] = ""
    entities: Annotated[list[Entity], Sequence[Entity]] = DEFAULT


class Graph(Message, typename="micro_ros_msgs/msg/Graph"):
    """Graph, as micro-ROS defines it."""

    nodes: Annotated[list[Node], Sequence[Node]] = DEFAULT
