"""The services of a running system: its status, and requests to stop and restart members."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Protocol

from aionode.errors import AionodeError
from aionode.interfaces.std_msgs.msg import String
from aionode.message import Message, ServiceType

if TYPE_CHECKING:
    from collections.abc import Sequence

    from aionode.node import Node
    from aionode.system._log import SystemLog
    from aionode.system._status import MemberStatus

__all__ = ["Control", "SystemCommand"]


class SystemCommand(ServiceType, typename="aionode_system/srv/SystemCommand"):
    """A request to a running system: ``status``, ``restart`` or ``stop``."""

    class Request(Message):
        """A command and the member it is for; an empty name stands for the system."""

        command: str
        name: str

    class Response(Message):
        """Whether it succeeded, and the states of the members as JSON or the reason why not."""

        success: bool
        text: str


class Controlled(Protocol):
    """The methods of a system that its services call."""

    log: SystemLog

    def status(self) -> dict[str, MemberStatus]:
        """Return the status of all members."""
        ...

    async def stop(self, name: str) -> None:
        """Stop a member."""
        ...

    async def restart(self, name: str) -> None:
        """Stop and start a member."""
        ...

    def request_end(self) -> None:
        """End the system."""
        ...


class Control:
    """Serves requests to one system through its node, and publishes its log if anyone listens.

    Args:
        system: The system.
        node: The node.
    """

    def __init__(self, system: Controlled, node: Node) -> None:
        self._system = system
        node.create_service(SystemCommand, "~/command", self._serve, concurrent=True)
        self._log = node.create_publisher(String, "~/log", 100)
        system.log.listeners.append(self._publish)

    def close(self) -> None:
        """Stop publishing."""
        self._system.log.listeners.remove(self._publish)

    def _publish(self, lines: Sequence[bytes | memoryview]) -> None:
        if self._log.get_subscription_count() > 0:
            self._log.publish(String(data=b"".join(lines).decode(errors="replace")))

    async def _serve(self, request: SystemCommand.Request) -> SystemCommand.Response:
        try:
            return SystemCommand.Response(success=True, text=await self._do(request))
        except (AionodeError, ValueError) as error:
            return SystemCommand.Response(success=False, text=str(error))

    async def _do(self, request: SystemCommand.Request) -> str:
        if request.command == "stop" and not request.name:
            self._system.request_end()
        elif request.command == "stop":
            await self._system.stop(request.name)
        elif request.command == "restart":
            await self._system.restart(request.name)
        elif request.command != "status":
            raise ValueError(f"{request.command!r} is unknown; use status, stop or restart")
        statuses = self._system.status().values()
        return json.dumps([status.record() for status in statuses])
