"""Services of diagnostic_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated

from aionode.interfaces.diagnostic_msgs.msg import DiagnosticStatus
from aionode.message import DEFAULT, Message, Sequence, ServiceType, byte

__all__ = ["AddDiagnostics", "SelfTest"]


class AddDiagnostics(ServiceType, typename="diagnostic_msgs/srv/AddDiagnostics"):
    """AddDiagnostics."""

    class Request(Message):
        """The request of AddDiagnostics."""

        load_namespace: str = ""

    class Response(Message):
        """The response of AddDiagnostics."""

        success: bool = False
        message: str = ""


class SelfTest(ServiceType, typename="diagnostic_msgs/srv/SelfTest"):
    """SelfTest."""

    class Request(Message):
        """The request of SelfTest."""

    class Response(Message):
        """The response of SelfTest."""

        id: str = ""
        passed: byte = b"\x00"
        status: Annotated[list[DiagnosticStatus], Sequence[DiagnosticStatus]] = DEFAULT
