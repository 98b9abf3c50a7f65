"""The members of a system as others see them: their states, and how they ended."""

from __future__ import annotations

import signal
from dataclasses import asdict, dataclass
from typing import Any, Literal

__all__ = ["MemberEnd", "MemberStatus", "State", "SystemHealth", "shell_status"]

State = Literal[
    "waiting", "starting", "running", "restarting", "stopping", "stopped", "ended", "failed"
]
"""``waiting``: for those that it starts after. ``stopped``: on request. ``ended``: by itself, with
status 0. ``failed``: for good, as it is not restarted."""


@dataclass(frozen=True)
class MemberEnd:
    """How one run of a member ended.

    Attributes:
        name: The member.
        failed: Whether it failed.
        text: How it ended, such as ``ended with exit status 3`` or ``was killed by SIGSEGV``.
        status: Its exit status as a shell has it; that of a node that failed is 1.
        ran_sec: How long it had run, in seconds.
        last_lines: What it printed last, 20 lines at most.
        code: The exit code of its process as `subprocess` has it, negative for a signal; None for
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
        state: ``"waiting"`` (for those that it starts after), ``"starting"``, ``"running"``,
            ``"restarting"`` (soon), ``"stopping"``, ``"stopped"`` (on request), ``"ended"`` (by
            itself, with status 0) or ``"failed"``.
        pid: Its process; None while there is none. That of a node in this process is this one.
        restarts: How often it was started again.
        ready: Whether all that was awaited of it has come.
        exit_status: How its last run ended, as a shell has it; None if none has.
        uptime_sec: How long it has been running, in seconds; 0 while it is not.
        cpu_percent: The share of a core that its first process takes, since the last look; None
            where psutil is missing, or it is unknown.
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
        """Return it as JSON has it."""
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
    """Return an exit code as a shell has it: 128 and more for signals; 1 if it is not known."""
    if code is None:
        return 1
    return 128 - code if code < 0 else code


def end_text(code: int | None) -> str:
    """Return how a process ended, given its exit code; None if that is not known."""
    if code is None:
        return "ended; how, only the guardian knew"
    if code >= 0:
        return f"ended with exit status {code}"
    try:
        return f"was killed by {signal.Signals(-code).name}"
    except ValueError:  # a real-time signal
        return f"was killed by signal {-code}"
