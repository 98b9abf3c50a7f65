"""Reports the events of a process to event handlers, in the order in which they happen."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from launch.events.process import (
    ProcessExited,
    ProcessStarted,
    ProcessStderr,
    ProcessStdout,
)

if TYPE_CHECKING:
    from aionode.launch.plan import Process
    from aionode.system import Member, MemberEnd
    from launch.event import Event

__all__ = ["ProcessEvents"]


class ProcessEvents:
    """Creates the events of one process, over all its runs.

    Args:
        step: The process.
        argv: Its command line.
        tell: Called with each event.
    """

    def __init__(self, step: Process, argv: list[str], tell: Callable[[Event], object]) -> None:
        self._action = step.action
        self._facts: dict[str, Any] = {"action": step.action, "name": step.name, "cmd": argv}
        self._facts |= {"cwd": step.cwd, "env": step.env}
        self._tell = tell
        self._pid: int | None = None
        self._end: MemberEnd | None = None
        self._early: list[tuple[bytes, int]] = []
        """Output that the process printed before handlers learned of its start."""

    def look(self, member: Member) -> None:
        """Report a start or end that has not been reported yet."""
        ended = member.last_end if member.last_end is not self._end else None
        # A process that ended at once may never have been seen running.
        ran_unseen = ended is not None and ended.ran_sec > 0 and self._pid is None
        if ran_unseen or member.pid not in (None, self._pid):
            self._note_start(member.pid or 0)
        if ended is not None:
            self._end = ended
            code = ended.status if ended.code is None else ended.code
            self._action.return_code = code
            self._tell(ProcessExited(pid=self._pid or 0, returncode=code, **self._facts))
            self._pid = None

    def _note_start(self, pid: int) -> None:
        self._pid = pid
        names = ("name", "cmd")
        self._action.process_details = {"pid": pid, **{key: self._facts[key] for key in names}}
        self._tell(ProcessStarted(pid=pid, **self._facts))
        early, self._early = self._early, []
        for output, stream in early:
            self.note_output(output, stream)

    def note_output(self, output: bytes, stream: int) -> None:
        """Report output; stream 1 is standard output, 2 is standard error."""
        if self._pid is None:
            self._early.append((output, stream))
        else:
            kind = ProcessStderr if stream == 2 else ProcessStdout
            self._tell(kind(text=output, pid=self._pid, **self._facts))
