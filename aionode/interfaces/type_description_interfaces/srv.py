"""Services of type_description_interfaces.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated

from aionode.interfaces.type_description_interfaces.msg import KeyValue, TypeDescription, TypeSource
from aionode.message import DEFAULT, Message, Sequence, ServiceType

__all__ = ["GetTypeDescription"]


class GetTypeDescription(
    ServiceType, typename="type_description_interfaces/srv/GetTypeDescription"
):
    """Ask a node how it defines a type."""

    class Request(Message):
        """ROS name and hash of the type, and whether the source text is wanted."""

        type_name: str = ""
        type_hash: str = ""
        include_type_sources: bool = False

    class Response(Message):
        """The description, or why there is none."""

        successful: bool = False
        failure_reason: str = ""
        type_description: TypeDescription = DEFAULT
        type_sources: Annotated[list[TypeSource], Sequence[TypeSource]] = DEFAULT
        extra_information: Annotated[list[KeyValue], Sequence[KeyValue]] = DEFAULT
