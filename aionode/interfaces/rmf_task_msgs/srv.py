"""Services of rmf_task_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated

from aionode.interfaces.rmf_task_msgs.msg import DispatchStates, TaskDescription
from aionode.message import DEFAULT, Message, Sequence, ServiceType

__all__ = ["ApiService", "CancelTask", "GetDispatchStates", "ReviveTask", "SubmitTask"]


class ApiService(ServiceType, typename="rmf_task_msgs/srv/ApiService"):
    """ApiService, as Open-RMF defines it."""

    class Request(Message):
        """The request of ApiService."""

        json_msg: str = ""

    class Response(Message):
        """The response of ApiService."""

        json_msg: str = ""


class CancelTask(ServiceType, typename="rmf_task_msgs/srv/CancelTask"):
    """CancelTask, as Open-RMF defines it."""

    class Request(Message):
        """The request of CancelTask."""

        requester: str = ""
        task_id: str = ""

    class Response(Message):
        """The response of CancelTask."""

        success: bool = False
        message: str = ""


class GetDispatchStates(ServiceType, typename="rmf_task_msgs/srv/GetDispatchStates"):
    """GetDispatchStates, as Open-RMF defines it."""

    class Request(Message):
        """The request of GetDispatchStates."""

        task_ids: Annotated[list[str], Sequence[str]] = DEFAULT

    class Response(Message):
        """The response of GetDispatchStates."""

        success: bool = False
        states: DispatchStates = DEFAULT


class ReviveTask(ServiceType, typename="rmf_task_msgs/srv/ReviveTask"):
    """ReviveTask, as Open-RMF defines it."""

    class Request(Message):
        """The request of ReviveTask."""

        requester: str = ""
        task_id: str = ""

    class Response(Message):
        """The response of ReviveTask."""

        success: bool = False


class SubmitTask(ServiceType, typename="rmf_task_msgs/srv/SubmitTask"):
    """SubmitTask, as Open-RMF defines it."""

    class Request(Message):
        """The request of SubmitTask."""

        requester: str = ""
        description: TaskDescription = DEFAULT

    class Response(Message):
        """The response of SubmitTask."""

        success: bool = False
        task_id: str = ""
        message: str = ""
