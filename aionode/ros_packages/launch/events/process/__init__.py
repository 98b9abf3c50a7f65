"""`launch.events.process`: events of processes, and requests to them."""

from __future__ import annotations

import signal
from collections.abc import Callable
from typing import Any

from launch.event import Event

__all__ = [
    "ProcessExited",
    "ProcessIO",
    "ProcessStarted",
    "ProcessStderr",
    "ProcessStdin",
    "ProcessStdout",
    "ProcessTargetedEvent",
    "RunningProcessEvent",
    "ShutdownProcess",
    "SignalProcess",
    "matches_action",
    "matches_executable",
    "matches_name",
    "matches_pid",
]


class RunningProcessEvent(Event):
    """An event of a process."""

    name = "launch.events.process.RunningProcessEvent"

    def __init__(
        self,
        *,
        action: Any,
        name: str,
        cmd: list[str],
        cwd: str | None,
        env: dict[str, str] | None,
        pid: int,
    ) -> None:
        self.action = action
        self.execute_process_action = action
        self.process_name = name
        self.cmd = cmd
        self.cwd = cwd
        self.env = env
        self.pid = pid


class ProcessStarted(RunningProcessEvent):
    """A process has started."""

    name = "launch.events.process.ProcessStarted"


class ProcessExited(RunningProcessEvent):
    """A process has ended."""

    name = "launch.events.process.ProcessExited"

    def __init__(self, *, returncode: int, **of_process: Any) -> None:
        super().__init__(**of_process)
        self.returncode = returncode


class ProcessIO(RunningProcessEvent):
    """A process has written something."""

    name = "launch.events.process.ProcessIO"

    def __init__(self, *, text: bytes, fd: int = 1, **of_process: Any) -> None:
        super().__init__(**of_process)
        self.text = text
        self.from_stdin, self.from_stdout, self.from_stderr = fd == 0, fd == 1, fd == 2


class ProcessStdout(ProcessIO):
    """A process has written to its standard output."""

    name = "launch.events.process.ProcessStdout"

    def __init__(self, *, text: bytes, **of_process: Any) -> None:
        super().__init__(text=text, fd=1, **of_process)


class ProcessStderr(ProcessIO):
    """A process has written to its standard error."""

    name = "launch.events.process.ProcessStderr"

    def __init__(self, *, text: bytes, **of_process: Any) -> None:
        super().__init__(text=text, fd=2, **of_process)


class ProcessTargetedEvent(Event):
    """A request to some processes."""

    name = "launch.events.process.ProcessTargetedEvent"

    def __init__(self, *, process_matcher: Callable[[Any], bool]) -> None:
        self.process_matcher = process_matcher


class ShutdownProcess(ProcessTargetedEvent):
    """The request to stop processes."""

    name = "launch.events.process.ShutdownProcess"


class SignalProcess(ProcessTargetedEvent):
    """The request to send a signal to processes."""

    name = "launch.events.process.SignalProcess"

    def __init__(
        self, *, signal_number: str | int | signal.Signals, process_matcher: Callable[[Any], bool]
    ) -> None:
        super().__init__(process_matcher=process_matcher)
        if isinstance(signal_number, str):
            signal_number = signal.Signals[signal_number]
        self.signal = signal.Signals(signal_number)
        self.signal_name = self.signal.name


class ProcessStdin(ProcessTargetedEvent):
    """The request to pass input to processes."""

    name = "launch.events.process.ProcessStdin"

    def __init__(self, *, text: bytes, process_matcher: Callable[[Any], bool]) -> None:
        super().__init__(process_matcher=process_matcher)
        self.text = text


def matches_action(action: Any) -> Callable[[Any], bool]:
    """Return a matcher for the process of one action."""
    return lambda candidate: candidate is action


def matches_name(name: str) -> Callable[[Any], bool]:
    """Return a matcher for processes with a name."""
    return lambda candidate: (
        candidate.process_details is not None and candidate.process_details["name"] == name
    )


def matches_pid(pid: int) -> Callable[[Any], bool]:
    """Return a matcher for the process with a PID."""
    return lambda candidate: (
        candidate.process_details is not None and candidate.process_details["pid"] == pid
    )


def matches_executable(executable: str) -> Callable[[Any], bool]:
    """Return a matcher for processes of a program."""
    return lambda candidate: (
        candidate.process_details is not None
        and candidate.process_details["cmd"][0].endswith(executable)
    )
