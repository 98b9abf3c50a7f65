"""diagnostic_msgs."""

from typing import Annotated

from aionode.interfaces.diagnostic_msgs.msg import DiagnosticStatus
from aionode.message import DEFAULT, Message, Sequence, ServiceType, byte


class AddDiagnostics(ServiceType, typename="diagnostic_msgs/srv/AddDiagnostics"):
    """AddDiagnostics."""

    class Request(Message):
        """Request."""

        load_namespace: str = ""

    class Response(Message):
        """Response."""

        success: bool = False
        message: str = ""


class SelfTest(ServiceType, typename="diagnostic_msgs/srv/SelfTest"):
    """SelfTest."""

    class Request(Message):
        """Request."""

    class Response(Message):
        """Response."""

        id: str = ""
        passed: byte = b"\0"
        status: Annotated[list[DiagnosticStatus], Sequence[DiagnosticStatus]] = DEFAULT
