"""Services of py_trees_ros_interfaces.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated

from aionode.interfaces.py_trees_ros_interfaces.msg import (
    PublisherDetails,
    ServiceDetails,
    SnapshotStreamParameters,
    SubscriberDetails,
)
from aionode.message import DEFAULT, Message, Sequence, ServiceType

__all__ = [
    "CloseBlackboardStream",
    "CloseSnapshotStream",
    "GetBlackboardVariables",
    "IntrospectPublishers",
    "IntrospectServices",
    "IntrospectSubscribers",
    "OpenBlackboardStream",
    "OpenSnapshotStream",
    "ReconfigureSnapshotStream",
    "StatusReport",
]


class CloseBlackboardStream(
    ServiceType, typename="py_trees_ros_interfaces/srv/CloseBlackboardStream"
):
    """CloseBlackboardStream, as py_trees_ros defines it."""

    class Request(Message):
        """The request of CloseBlackboardStream."""

        topic_name: str = ""

    class Response(Message):
        """The response of CloseBlackboardStream."""

        result: bool = False


class CloseSnapshotStream(ServiceType, typename="py_trees_ros_interfaces/srv/CloseSnapshotStream"):
    """CloseSnapshotStream, as py_trees_ros defines it."""

    class Request(Message):
        """The request of CloseSnapshotStream."""

        topic_name: str = ""

    class Response(Message):
        """The response of CloseSnapshotStream."""

        result: bool = False


class GetBlackboardVariables(
    ServiceType, typename="py_trees_ros_interfaces/srv/GetBlackboardVariables"
):
    """GetBlackboardVariables, as py_trees_ros defines it."""

    class Request(Message):
        """The request of GetBlackboardVariables."""

    class Response(Message):
        """The response of GetBlackboardVariables."""

        variables: Annotated[list[str], Sequence[str]] = DEFAULT


class IntrospectPublishers(
    ServiceType, typename="py_trees_ros_interfaces/srv/IntrospectPublishers"
):
    """IntrospectPublishers, as py_trees_ros defines it."""

    class Request(Message):
        """The request of IntrospectPublishers."""

    class Response(Message):
        """The response of IntrospectPublishers."""

        publisher_details: Annotated[list[PublisherDetails], Sequence[PublisherDetails]] = DEFAULT


class IntrospectServices(ServiceType, typename="py_trees_ros_interfaces/srv/IntrospectServices"):
    """IntrospectServices, as py_trees_ros defines it."""

    class Request(Message):
        """The request of IntrospectServices."""

    class Response(Message):
        """The response of IntrospectServices."""

        service_details: Annotated[list[ServiceDetails], Sequence[ServiceDetails]] = DEFAULT


class IntrospectSubscribers(
    ServiceType, typename="py_trees_ros_interfaces/srv/IntrospectSubscribers"
):
    """IntrospectSubscribers, as py_trees_ros defines it."""

    class Request(Message):
        """The request of IntrospectSubscribers."""

    class Response(Message):
        """The response of IntrospectSubscribers."""

        subscriber_details: Annotated[list[SubscriberDetails], Sequence[SubscriberDetails]] = (
            DEFAULT
        )


class OpenBlackboardStream(
    ServiceType, typename="py_trees_ros_interfaces/srv/OpenBlackboardStream"
):
    """OpenBlackboardStream, as py_trees_ros defines it."""

    class Request(Message):
        """The request of OpenBlackboardStream."""

        variables: Annotated[list[str], Sequence[str]] = DEFAULT
        filter_on_visited_path: bool = False
        with_activity_stream: bool = False

    class Response(Message):
        """The response of OpenBlackboardStream."""

        topic: str = ""


class OpenSnapshotStream(ServiceType, typename="py_trees_ros_interfaces/srv/OpenSnapshotStream"):
    """OpenSnapshotStream, as py_trees_ros defines it."""

    class Request(Message):
        """The request of OpenSnapshotStream."""

        topic_name: str = ""
        parameters: SnapshotStreamParameters = DEFAULT

    class Response(Message):
        """The response of OpenSnapshotStream."""

        topic_name: str = ""


class ReconfigureSnapshotStream(
    ServiceType, typename="py_trees_ros_interfaces/srv/ReconfigureSnapshotStream"
):
    """ReconfigureSnapshotStream, as py_trees_ros defines it."""

    class Request(Message):
        """The request of ReconfigureSnapshotStream."""

        topic_name: str = ""
        parameters: SnapshotStreamParameters = DEFAULT

    class Response(Message):
        """The response of ReconfigureSnapshotStream."""

        result: bool = False


class StatusReport(ServiceType, typename="py_trees_ros_interfaces/srv/StatusReport"):
    """StatusReport, as py_trees_ros defines it."""

    class Request(Message):
        """The request of StatusReport."""

    class Response(Message):
        """The response of StatusReport."""

        report: str = ""
