"""The way back to one client of rosbridge: ops, fragments and statuses."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from aionode.errors import MessageError
from aionode.gateway.session.frames import Fragmented, op_frame

if TYPE_CHECKING:
    from aionode.gateway.session.session import Session

__all__ = ["Link"]

MOST_OP: Final = 60
"""The longest name of an op that is told back, in characters."""

LEVELS: Final = ("none", "error", "warning", "info")


class Link:
    """The way to one client.

    Args:
        session: The session of the client.
    """

    def __init__(self, session: Session) -> None:
        self.session = session
        self._level = 0

    def set_level(self, level: str) -> None:
        """Send statuses up to a level from now on, which clients can read that ask for it.

        Raises:
            MessageError: there is no such level.
        """
        if level not in LEVELS:
            raise MessageError("set_level.level", f"{level!r}, needs one of {', '.join(LEVELS)}")
        self._level = LEVELS.index(level)

    def send(self, op: dict[str, Any], fragment_size: float = 0) -> None:
        """Send an op, in fragments if it is longer than a size that the client has asked for."""
        frame = op_frame({key: value for key, value in op.items() if value is not None})
        if fragment_size:
            frame = Fragmented.of(frame, max(int(fragment_size), 1), str(op.get("id", "")))
        self.session.outbox.send(frame)

    def fail(self, error: Exception, op: dict[str, Any] | None = None, what: str = "") -> None:
        """Say that something of the client has failed: to it by a status, and in the log.

        Args:
            error: Why.
            op: The op.
            what: What has failed; by default the op.
        """
        what = what or (str(op["op"])[:MOST_OP] if op is not None else "")
        self.session.note_failure(error, what)
        text = str(error) or "no answer in time"
        self.status("error", f"{what}: {text}" if what else text, op)

    def status(self, level: str, text: str, op: dict[str, Any] | None = None) -> None:
        """Tell the client what became of an op, if it has asked for statuses of this level."""
        if LEVELS.index(level) > self._level:
            return
        message_id = None if op is None else op.get("id")
        if not isinstance(message_id, str):
            message_id = None
        self.send({"op": "status", "level": level, "msg": text, "id": message_id})
