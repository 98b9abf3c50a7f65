"""The public status of a system's members: their states, and how they ended."""

from __future__ import annotations

import signal
from dataclasses import asdict, dataclass
from typing import Any, Literal

__all__ = ["MemberEnd", "MemberStatus", "State", "SystemHealth", "shell_status"]

State = Literal[
    "waiting", "starting", "running", "restarting", "stopping", "stopped", "ended", "failed"
]
"""``waiting``: for the members it starts after. ``stopped``: on request. ``ended``: by itself, with
status 0. ``failed``: for good, without another restart.
"""


@dataclass(frozen=True)
class MemberEnd:
    """How one run of a member ended.

    Attributes:
        name: The member.
        failed: Whether it failed.
        text: How it ended, such as ``ended with exit status 3`` or ``was killed by SIGSEGV``.
        status: Its exit status in a shell's terms; 1 for a node that failed.
        ran_sec: How long it ran, in seconds.
        last_lines: The last lines that it printed, at most 20.
        code: The exit code of its process in `subprocess`'s terms, negative for a signal; None for
            a node in this process, and for a process that could not be started.
    """

    name: str
    failed: bool
    text: str
    status: int
    ran_sec: float = 0.0
    last_lines: tuple[str, ...] = ()
    code: int | None = None


@dataclass(frozen=True)
class MemberStatus:
    """The present state of a member of a system.

    Attributes:
        name: Its name in the system.
        state: ``"waiting"`` (for the members it starts after), ``"starting"``, ``"running"``,
            ``"restarting"`` (soon), ``"stopping"``, ``"stopped"`` (on request), ``"ended"`` (by
            itself, with status 0) or ``"failed"``.
        pid: Its process, which for a node in this process is this one; None while there is none.
        restarts: How often it was started again.
        ready: Whether everything awaited of it is there.
        exit_status: How its last run ended, in a shell's terms; None if none has ended.
        uptime_sec: How long it has been running, in seconds; 0 while it is not.
        cpu_percent: The share of a core used by its first process since the last call; None if
            unknown or without psutil.
        memory_bytes: Resident memory of its first process; None as above.
        error: Why its last run failed, or why it is not ready, in one line.
    """

    name: str
    state: State
    pid: int | None
    restarts: int
    ready: bool
    exit_status: int | None
    uptime_sec: float
    cpu_percent: float | None
    memory_bytes: int | None
    error: str

    def record(self) -> dict[str, Any]:
        """Return the status as JSON-compatible values."""
        return asdict(self)


@dataclass(frozen=True)
class SystemHealth:
    """The health of a system, for an HTTP endpoint such as ``/healthz``.

    Attributes:
        ok: Whether every member that should run is running and ready: HTTP status 200, otherwise
            503.
        ready: Whether `System.ready` would return at once.
        problems: What is wrong: a line for each member, and one if the guardian is gone; empty if
            `ok`.
        members: The state of each member, by its name.
    """

    ok: bool
    ready: bool
    problems: tuple[str, ...]
    members: dict[str, State]


def shell_status(code: int | None) -> int:
    """Convert an exit code to a shell's: 128 and more for signals; 1 if unknown."""
    if code is None:
        return 1
    return 128 - code if code < 0 else code


def end_text(code: int | None) -> str:
    """Describe how a process ended, given its exit code, or None if unknown."""
    if code is None:
        return "ended; its exit status was lost with the guardian"
    if code >= 0:
        return f"ended with exit status {code}"
    try:
        return f"was killed by {signal.Signals(-code).name}"
    except ValueError:  # a real-time signal
        return f"was killed by signal {-code}"
