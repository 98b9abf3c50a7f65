"""Services of composition_interfaces.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated

from aionode.interfaces.rcl_interfaces.msg import Parameter
from aionode.message import DEFAULT, Ints, Message, Sequence, ServiceType, uint8, uint64

__all__ = ["ListNodes", "LoadNode", "UnloadNode"]


class ListNodes(ServiceType, typename="composition_interfaces/srv/ListNodes"):
    """Which nodes a component container runs."""

    class Request(Message):
        """The request of ListNodes."""

    class Response(Message):
        """Names and ids of the nodes; both lists have the same order."""

        full_node_names: Annotated[list[str], Sequence[str]] = DEFAULT
        unique_ids: Annotated[Ints, Sequence[uint64]] = DEFAULT


class LoadNode(ServiceType, typename="composition_interfaces/srv/LoadNode"):
    """Load a node into a component container."""

    class Request(Message):
        """Which component to load, and how its node is to be set up.

        Attributes:
            package_name: The package that has the component.
            plugin_name: The component's class, such as ``demo_nodes_cpp::Talker``.
            node_name: Name for the node; its own if empty.
            node_namespace: Namespace for the node; its own if empty.
            log_level: Severity as in rcl_interfaces/msg/Log; 0 leaves it unchanged.
            remap_rules: Rules such as ``chatter:=/news``.
            parameters: Parameters for the node.
            extra_arguments: Options for the container, such as ``use_intra_process_comms``.
        """

        package_name: str = ""
        plugin_name: str = ""
        node_name: str = ""
        node_namespace: str = ""
        log_level: uint8 = 0
        remap_rules: Annotated[list[str], Sequence[str]] = DEFAULT
        parameters: Annotated[list[Parameter], Sequence[Parameter]] = DEFAULT
        extra_arguments: Annotated[list[Parameter], Sequence[Parameter]] = DEFAULT

    class Response(Message):
        """Whether the node was loaded, or why not, and the id for unloading it."""

        success: bool = False
        error_message: str = ""
        full_node_name: str = ""
        unique_id: uint64 = 0


class UnloadNode(ServiceType, typename="composition_interfaces/srv/UnloadNode"):
    """Remove a node from a component container."""

    class Request(Message):
        """The id that LoadNode returned."""

        unique_id: uint64 = 0

    class Response(Message):
        """Whether the node was removed, or why not."""

        success: bool = False
        error_message: str = ""
