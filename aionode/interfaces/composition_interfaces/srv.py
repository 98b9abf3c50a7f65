"""Services of composition_interfaces.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated

from aionode.interfaces.rcl_interfaces.msg import Parameter
from aionode.message import DEFAULT, Ints, Message, Sequence, ServiceType, uint8, uint64

__all__ = ["ListNodes", "LoadNode", "UnloadNode"]


class ListNodes(ServiceType, typename="composition_interfaces/srv/ListNodes"):
    """ListNodes."""

    class Request(Message):
        """The request of ListNodes."""

    class Response(Message):
        """The response of ListNodes."""

        full_node_names: Annotated[list[str], Sequence[str]] = DEFAULT
        unique_ids: Annotated[Ints, Sequence[uint64]] = DEFAULT


class LoadNode(ServiceType, typename="composition_interfaces/srv/LoadNode"):
    """LoadNode."""

    class Request(Message):
        """The request of LoadNode."""

        package_name: str = ""
        plugin_name: str = ""
        node_name: str = ""
        node_namespace: str = ""
        log_level: uint8 = 0
        remap_rules: Annotated[list[str], Sequence[str]] = DEFAULT
        parameters: Annotated[list[Parameter], Sequence[Parameter]] = DEFAULT
        extra_arguments: Annotated[list[Parameter], Sequence[Parameter]] = DEFAULT

    class Response(Message):
        """The response of LoadNode."""

        success: bool = False
        error_message: str = ""
        full_node_name: str = ""
        unique_id: uint64 = 0


class UnloadNode(ServiceType, typename="composition_interfaces/srv/UnloadNode"):
    """UnloadNode."""

    class Request(Message):
        """The request of UnloadNode."""

        unique_id: uint64 = 0

    class Response(Message):
        """The response of UnloadNode."""

        success: bool = False
        error_message: str = ""
