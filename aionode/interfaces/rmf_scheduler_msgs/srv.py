"""Services of rmf_scheduler_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated

from aionode.interfaces.rmf_scheduler_msgs.msg import Schedule, ScheduleState, Trigger, TriggerState
from aionode.message import DEFAULT, Message, Sequence, ServiceType, int64

__all__ = [
    "CancelAll",
    "CancelSchedule",
    "CancelTrigger",
    "CreateSchedule",
    "CreateTrigger",
    "ListScheduleStates",
    "ListSchedules",
    "ListTriggerStates",
    "ListTriggers",
]


class CancelAll(ServiceType, typename="rmf_scheduler_msgs/srv/CancelAll"):
    """CancelAll, as Open-RMF defines it."""

    class Request(Message):
        """The request of CancelAll."""

        group: str = ""

    class Response(Message):
        """The response of CancelAll."""

        success: bool = False
        message: str = ""


class CancelSchedule(ServiceType, typename="rmf_scheduler_msgs/srv/CancelSchedule"):
    """CancelSchedule, as Open-RMF defines it."""

    class Request(Message):
        """The request of CancelSchedule."""

        name: str = ""
        finished: bool = False

    class Response(Message):
        """The response of CancelSchedule."""

        success: bool = False
        message: str = ""


class CancelTrigger(ServiceType, typename="rmf_scheduler_msgs/srv/CancelTrigger"):
    """CancelTrigger, as Open-RMF defines it."""

    class Request(Message):
        """The request of CancelTrigger."""

        name: str = ""

    class Response(Message):
        """The response of CancelTrigger."""

        success: bool = False
        message: str = ""


class CreateSchedule(ServiceType, typename="rmf_scheduler_msgs/srv/CreateSchedule"):
    """CreateSchedule, as Open-RMF defines it."""

    class Request(Message):
        """The request of CreateSchedule."""

        schedule: Schedule = DEFAULT

    class Response(Message):
        """The response of CreateSchedule."""

        success: bool = False
        message: str = ""


class CreateTrigger(ServiceType, typename="rmf_scheduler_msgs/srv/CreateTrigger"):
    """CreateTrigger, as Open-RMF defines it."""

    class Request(Message):
        """The request of CreateTrigger."""

        trigger: Trigger = DEFAULT

    class Response(Message):
        """The response of CreateTrigger."""

        success: bool = False
        message: str = ""


class ListScheduleStates(ServiceType, typename="rmf_scheduler_msgs/srv/ListScheduleStates"):
    """ListScheduleStates, as Open-RMF defines it."""

    class Request(Message):
        """The request of ListScheduleStates."""

        modified_after: int64 = 0

    class Response(Message):
        """The response of ListScheduleStates."""

        success: bool = False
        message: str = ""
        schedules: Annotated[list[ScheduleState], Sequence[ScheduleState]] = DEFAULT


class ListSchedules(ServiceType, typename="rmf_scheduler_msgs/srv/ListSchedules"):
    """ListSchedules, as Open-RMF defines it."""

    class Request(Message):
        """The request of ListSchedules."""

        created_after: int64 = 0

    class Response(Message):
        """The response of ListSchedules."""

        success: bool = False
        message: str = ""
        schedules: Annotated[list[Schedule], Sequence[Schedule]] = DEFAULT


class ListTriggerStates(ServiceType, typename="rmf_scheduler_msgs/srv/ListTriggerStates"):
    """ListTriggerStates, as Open-RMF defines it."""

    class Request(Message):
        """The request of ListTriggerStates."""

        modified_after: int64 = 0

    class Response(Message):
        """The response of ListTriggerStates."""

        success: bool = False
        message: str = ""
        triggers: Annotated[list[TriggerState], Sequence[TriggerState]] = DEFAULT


class ListTriggers(ServiceType, typename="rmf_scheduler_msgs/srv/ListTriggers"):
    """ListTriggers, as Open-RMF defines it."""

    class Request(Message):
        """The request of ListTriggers."""

        created_after: int64 = 0

    class Response(Message):
        """The response of ListTriggers."""

        success: bool = False
        message: str = ""
        triggers: Annotated[list[Trigger], Sequence[Trigger]] = DEFAULT
