"""composition_interfaces."""

from typing import Annotated

from aionode.interfaces.rcl_interfaces.msg import Parameter
from aionode.message import DEFAULT, Ints, Message, Sequence, ServiceType, uint64, uint8


class ListNodes(ServiceType, typename="composition_interfaces/srv/ListNodes"):
    """ListNodes."""

    class Request(Message):
        """Request."""

    class Response(Message):
        """Response."""

        full_node_names: Annotated[list[str], Sequence[str]] = DEFAULT
        unique_ids: Annotated[Ints, Sequence[uint64]] = DEFAULT


class LoadNode(ServiceType, typename="composition_interfaces/srv/LoadNode"):
    """LoadNode."""

    class Request(Message):
        """Request."""

        package_name: str = ""
        plugin_name: str = ""
        node_name: str = ""
        node_namespace: str = ""
        log_level: uint8 = 0
        remap_rules: Annotated[list[str], Sequence[str]] = DEFAULT
        parameters: Annotated[list[Parameter], Sequence[Parameter]] = DEFAULT
        extra_arguments: Annotated[list[Parameter], Sequence[Parameter]] = DEFAULT

    class Response(Message):
        """Response."""

        success: bool = False
        error_message: str = ""
        full_node_name: str = ""
        unique_id: uint64 = 0


class UnloadNode(ServiceType, typename="composition_interfaces/srv/UnloadNode"):
    """UnloadNode."""

    class Request(Message):
        """Request."""

        unique_id: uint64 = 0

    class Response(Message):
        """Response."""

        success: bool = False
        error_message: str = ""
