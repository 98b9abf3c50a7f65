"""Services of diagnostic_msgs.

Generated from its definitions by `aionode interface generate`, which keeps the docstrings.
"""

from typing import Annotated

from aionode.interfaces.diagnostic_msgs.msg import DiagnosticStatus
from aionode.message import DEFAULT, Message, Sequence, ServiceType, byte

__all__ = ["AddDiagnostics", "SelfTest"]


class AddDiagnostics(ServiceType, typename="diagnostic_msgs/srv/AddDiagnostics"):
    """Add analyzers to a diagnostics aggregator."""

    class Request(Message):
        """The namespace that holds the parameters of the analyzers."""

        load_namespace: str = ""

    class Response(Message):
        """Whether they were added, or why not."""

        success: bool = False
        message: str = ""


class SelfTest(ServiceType, typename="diagnostic_msgs/srv/SelfTest"):
    """Have a device test itself."""

    class Request(Message):
        """The request of SelfTest."""

    class Response(Message):
        """What was tested, whether all tests passed (not 0), and each outcome."""

        id: str = ""
        passed: byte = b"\x00"
        status: Annotated[list[DiagnosticStatus], Sequence[DiagnosticStatus]] = DEFAULT
