"""Services of rmf_traffic_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import ClassVar

from aionode.interfaces.rmf_traffic_msgs.msg import (
    ParticipantDescription,
    ScheduleIdentity,
    ScheduleQuery,
)
from aionode.message import DEFAULT, Message, ServiceType, uint8, uint64

__all__ = ["RegisterParticipant", "RegisterQuery", "RequestChanges", "UnregisterParticipant"]


class RegisterParticipant(ServiceType, typename="rmf_traffic_msgs/srv/RegisterParticipant"):
    """RegisterParticipant, as Open-RMF defines it."""

    class Request(Message):
        """The request of RegisterParticipant."""

        description: ParticipantDescription = DEFAULT

    class Response(Message):
        """The response of RegisterParticipant."""

        participant_id: uint64 = 0
        last_itinerary_version: uint64 = 0
        last_plan_id: uint64 = 0
        next_storage_base: uint64 = 0
        error: str = ""


class RegisterQuery(ServiceType, typename="rmf_traffic_msgs/srv/RegisterQuery"):
    """RegisterQuery, as Open-RMF defines it."""

    class Request(Message):
        """The request of RegisterQuery."""

        query: ScheduleQuery = DEFAULT

    class Response(Message):
        """The response of RegisterQuery."""

        node_id: ScheduleIdentity = DEFAULT
        query_id: uint64 = 0
        error: str = ""


class RequestChanges(ServiceType, typename="rmf_traffic_msgs/srv/RequestChanges"):
    """RequestChanges, as Open-RMF defines it."""

    class Request(Message):
        """The request of RequestChanges."""

        query_id: uint64 = 0
        version: uint64 = 0
        full_update: bool = False

    class Response(Message):
        """The response of RequestChanges."""

        REQUEST_ACCEPTED: ClassVar[uint8] = 1
        UNKNOWN_QUERY_ID: ClassVar[uint8] = 2
        ERROR: ClassVar[uint8] = 3

        node_id: ScheduleIdentity = DEFAULT
        result: uint8 = 0
        error: str = ""


class UnregisterParticipant(ServiceType, typename="rmf_traffic_msgs/srv/UnregisterParticipant"):
    """UnregisterParticipant, as Open-RMF defines it."""

    class Request(Message):
        """The request of UnregisterParticipant."""

        participant_id: uint64 = 0

    class Response(Message):
        """The response of UnregisterParticipant."""

        confirmation: bool = False
        error: str = ""
