"""Services of rosapi_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated

from aionode.interfaces.builtin_interfaces.msg import Time
from aionode.interfaces.rosapi_msgs.msg import TypeDef
from aionode.message import DEFAULT, Message, Sequence, uint8
from aionode.message import ServiceType as ServiceType_

__all__ = [
    "DeleteParam",
    "GetActionServers",
    "GetParam",
    "GetParamNames",
    "GetROSVersion",
    "GetTime",
    "HasParam",
    "MessageDetails",
    "NodeDetails",
    "Nodes",
    "Publishers",
    "ServiceNode",
    "ServiceProviders",
    "ServiceRequestDetails",
    "ServiceResponseDetails",
    "ServiceType",
    "Services",
    "ServicesForType",
    "SetParam",
    "Subscribers",
    "TopicType",
    "Topics",
    "TopicsAndRawTypes",
    "TopicsForType",
]


class DeleteParam(ServiceType_, typename="rosapi_msgs/srv/DeleteParam"):
    """DeleteParam, as rosbridge_suite defines it."""

    class Request(Message):
        """The request of DeleteParam."""

        name: str = ""

    class Response(Message):
        """The response of DeleteParam."""


class GetActionServers(ServiceType_, typename="rosapi_msgs/srv/GetActionServers"):
    """GetActionServers, as rosbridge_suite defines it."""

    class Request(Message):
        """The request of GetActionServers."""

    class Response(Message):
        """The response of GetActionServers."""

        action_servers: Annotated[list[str], Sequence[str]] = DEFAULT


class GetParam(ServiceType_, typename="rosapi_msgs/srv/GetParam"):
    """GetParam, as rosbridge_suite defines it."""

    class Request(Message):
        """The request of GetParam."""

        name: str = ""
        default_value: str = ""

    class Response(Message):
        """The response of GetParam."""

        value: str = ""


class GetParamNames(ServiceType_, typename="rosapi_msgs/srv/GetParamNames"):
    """GetParamNames, as rosbridge_suite defines it."""

    class Request(Message):
        """The request of GetParamNames."""

    class Response(Message):
        """The response of GetParamNames."""

        names: Annotated[list[str], Sequence[str]] = DEFAULT


class GetROSVersion(ServiceType_, typename="rosapi_msgs/srv/GetROSVersion"):
    """GetROSVersion, as rosbridge_suite defines it."""

    class Request(Message):
        """The request of GetROSVersion."""

    class Response(Message):
        """The response of GetROSVersion."""

        version: uint8 = 0
        distro: str = ""


class GetTime(ServiceType_, typename="rosapi_msgs/srv/GetTime"):
    """GetTime, as rosbridge_suite defines it."""

    class Request(Message):
        """The request of GetTime."""

    class Response(Message):
        """The response of GetTime."""

        time: Time = DEFAULT


class HasParam(ServiceType_, typename="rosapi_msgs/srv/HasParam"):
    """HasParam, as rosbridge_suite defines it."""

    class Request(Message):
        """The request of HasParam."""

        name: str = ""

    class Response(Message):
        """The response of HasParam."""

        exists: bool = False


class MessageDetails(ServiceType_, typename="rosapi_msgs/srv/MessageDetails"):
    """MessageDetails, as rosbridge_suite defines it."""

    class Request(Message):
        """The request of MessageDetails."""

        type: str = ""

    class Response(Message):
        """The response of MessageDetails."""

        typedefs: Annotated[list[TypeDef], Sequence[TypeDef]] = DEFAULT


class NodeDetails(ServiceType_, typename="rosapi_msgs/srv/NodeDetails"):
    """NodeDetails, as rosbridge_suite defines it."""

    class Request(Message):
        """The request of NodeDetails."""

        node: str = ""

    class Response(Message):
        """The response of NodeDetails."""

        subscribing: Annotated[list[str], Sequence[str]] = DEFAULT
        publishing: Annotated[list[str], Sequence[str]] = DEFAULT
        services: Annotated[list[str], Sequence[str]] = DEFAULT


class Nodes(ServiceType_, typename="rosapi_msgs/srv/Nodes"):
    """Nodes, as rosbridge_suite defines it."""

    class Request(Message):
        """The request of Nodes."""

    class Response(Message):
        """The response of Nodes."""

        nodes: Annotated[list[str], Sequence[str]] = DEFAULT


class Publishers(ServiceType_, typename="rosapi_msgs/srv/Publishers"):
    """Publishers, as rosbridge_suite defines it."""

    class Request(Message):
        """The request of Publishers."""

        topic: str = ""

    class Response(Message):
        """The response of Publishers."""

        publishers: Annotated[list[str], Sequence[str]] = DEFAULT


class ServiceNode(ServiceType_, typename="rosapi_msgs/srv/ServiceNode"):
    """ServiceNode, as rosbridge_suite defines it."""

    class Request(Message):
        """The request of ServiceNode."""

        service: str = ""

    class Response(Message):
        """The response of ServiceNode."""

        node: str = ""


class ServiceProviders(ServiceType_, typename="rosapi_msgs/srv/ServiceProviders"):
    """ServiceProviders, as rosbridge_suite defines it."""

    class Request(Message):
        """The request of ServiceProviders."""

        service: str = ""

    class Response(Message):
        """The response of ServiceProviders."""

        providers: Annotated[list[str], Sequence[str]] = DEFAULT


class ServiceRequestDetails(ServiceType_, typename="rosapi_msgs/srv/ServiceRequestDetails"):
    """ServiceRequestDetails, as rosbridge_suite defines it."""

    class Request(Message):
        """The request of ServiceRequestDetails."""

        type: str = ""

    class Response(Message):
        """The response of ServiceRequestDetails."""

        typedefs: Annotated[list[TypeDef], Sequence[TypeDef]] = DEFAULT


class ServiceResponseDetails(ServiceType_, typename="rosapi_msgs/srv/ServiceResponseDetails"):
    """ServiceResponseDetails, as rosbridge_suite defines it."""

    class Request(Message):
        """The request of ServiceResponseDetails."""

        type: str = ""

    class Response(Message):
        """The response of ServiceResponseDetails."""

        typedefs: Annotated[list[TypeDef], Sequence[TypeDef]] = DEFAULT


class ServiceType(ServiceType_, typename="rosapi_msgs/srv/ServiceType"):
    """ServiceType, as rosbridge_suite defines it."""

    class Request(Message):
        """The request of ServiceType."""

        service: str = ""

    class Response(Message):
        """The response of ServiceType."""

        type: str = ""


class Services(ServiceType_, typename="rosapi_msgs/srv/Services"):
    """Services, as rosbridge_suite defines it."""

    class Request(Message):
        """The request of Services."""

    class Response(Message):
        """The response of Services."""

        services: Annotated[list[str], Sequence[str]] = DEFAULT


class ServicesForType(ServiceType_, typename="rosapi_msgs/srv/ServicesForType"):
    """ServicesForType, as rosbridge_suite defines it."""

    class Request(Message):
        """The request of ServicesForType."""

        type: str = ""

    class Response(Message):
        """The response of ServicesForType."""

        services: Annotated[list[str], Sequence[str]] = DEFAULT


class SetParam(ServiceType_, typename="rosapi_msgs/srv/SetParam"):
    """SetParam, as rosbridge_suite defines it."""

    class Request(Message):
        """The request of SetParam."""

        name: str = ""
        value: str = ""

    class Response(Message):
        """The response of SetParam."""


class Subscribers(ServiceType_, typename="rosapi_msgs/srv/Subscribers"):
    """Subscribers, as rosbridge_suite defines it."""

    class Request(Message):
        """The request of Subscribers."""

        topic: str = ""

    class Response(Message):
        """The response of Subscribers."""

        subscribers: Annotated[list[str], Sequence[str]] = DEFAULT


class TopicType(ServiceType_, typename="rosapi_msgs/srv/TopicType"):
    """TopicType, as rosbridge_suite defines it."""

    class Request(Message):
        """The request of TopicType."""

        topic: str = ""

    class Response(Message):
        """The response of TopicType."""

        type: str = ""


class Topics(ServiceType_, typename="rosapi_msgs/srv/Topics"):
    """Topics, as rosbridge_suite defines it."""

    class Request(Message):
        """The request of Topics."""

    class Response(Message):
        """The response of Topics."""

        topics: Annotated[list[str], Sequence[str]] = DEFAULT
        types: Annotated[list[str], Sequence[str]] = DEFAULT


class TopicsAndRawTypes(ServiceType_, typename="rosapi_msgs/srv/TopicsAndRawTypes"):
    """TopicsAndRawTypes, as rosbridge_suite defines it."""

    class Request(Message):
        """The request of TopicsAndRawTypes."""

    class Response(Message):
        """The response of TopicsAndRawTypes."""

        topics: Annotated[list[str], Sequence[str]] = DEFAULT
        types: Annotated[list[str], Sequence[str]] = DEFAULT
        typedefs_full_text: Annotated[list[str], Sequence[str]] = DEFAULT


class TopicsForType(ServiceType_, typename="rosapi_msgs/srv/TopicsForType"):
    """TopicsForType, as rosbridge_suite defines it."""

    class Request(Message):
        """The request of TopicsForType."""

        type: str = ""

    class Response(Message):
        """The response of TopicsForType."""

        topics: Annotated[list[str], Sequence[str]] = DEFAULT
