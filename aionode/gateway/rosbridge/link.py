"""The way back to one rosbridge client: ops, fragments and statuses."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

import msgspec

from aionode.errors import MessageError
from aionode.gateway.rosbridge.request import id_of
from aionode.gateway.session.encoding.frames import Fragmented, op_frame

if TYPE_CHECKING:
    from aionode.gateway.session.session import Session

__all__ = ["Link", "raw_id"]

MAX_OP: Final = 60
"""The longest op name that is repeated in an answer, in characters."""

ANSWERS: Final = {
    "call_service": ("service_response", "service"),
    "send_action_goal": ("action_result", "action"),
}
"""The ops that are always answered: the op of the answer, and the field that names the subject."""

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
        """From now on send statuses up to a level, for clients that request it.

        Raises:
            MessageError: there is no such level.
        """
        if level not in LEVELS:
            raise MessageError("set_level.level", f"{level!r}; use one of {', '.join(LEVELS)}")
        self._level = LEVELS.index(level)

    def send(self, op: dict[str, Any], fragment_size: float = 0) -> None:
        """Send an op, in fragments if it is longer than the size requested by the client."""
        frame = op_frame({key: value for key, value in op.items() if value is not None})
        if fragment_size:
            message_id = op.get("id")
            told = bytes(message_id).decode() if isinstance(message_id, msgspec.Raw) else ""
            frame = Fragmented.of(frame, max(int(fragment_size), 1), told.strip('"'))
        self.session.outbox.send(frame)

    def fail(self, error: Exception, op: dict[str, Any] | None = None, what: str = "") -> None:
        """Report a failure to the client, and in the log.

        A call or a goal is always answered; failures of other ops are reported by a status.

        Args:
            error: Why.
            op: The op.
            what: The name of what failed; by default the op.
        """
        name = str(op["op"])[:MAX_OP] if op is not None else ""
        text = str(error) or "no answer in time"
        if op is None or name not in ANSWERS:
            what = what or name
            self.session.rights.note_failure(error, what)
            self.status("error", f"{what}: {text}" if what else text, op)
            return
        answer, field = ANSWERS[name]
        asked = op[field].partition("#")[0] if isinstance(op.get(field), str) else None
        self.session.rights.note_failure(error, f"{name} {asked or ''}".strip())
        told = {"op": answer, field: asked, "id": raw_id(op), "values": text, "result": False}
        self.send(told | ({"status": 0} if name == "send_action_goal" else {}))

    def status(self, level: str, text: str, op: dict[str, Any] | None = None) -> None:
        """Send the client the status of an op, if it has requested statuses of this level."""
        if LEVELS.index(level) > self._level:
            return
        message_id = None if op is None else raw_id(op)
        self.send({"op": "status", "level": level, "msg": text, "id": message_id})


def raw_id(op: dict[str, Any]) -> msgspec.Raw | None:
    """Return the id of an op, unchanged for the answer; None if it is missing or too long."""
    try:
        message_id = id_of(op)
    except MessageError:
        return None
    return None if message_id is None else msgspec.Raw(message_id)
