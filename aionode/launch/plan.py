"""The actions of a launch description, in order: the result of its evaluation."""

from __future__ import annotations

from collections.abc import Awaitable, Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

__all__ = [
    "Call",
    "Completed",
    "Component",
    "Emit",
    "LoadNodes",
    "Log",
    "Missing",
    "Opaque",
    "ParameterValues",
    "Process",
    "Step",
    "Timer",
    "Watch",
]


@dataclass(frozen=True)
class Missing:
    """A missing package, file or executable; whatever needs it is left out.

    Attributes:
        name: Its name.
        kind: ``package``, ``file`` or ``program``.
        executable: The executable that the package lacks; empty if the package is missing.
    """

    name: str
    kind: str = "package"
    executable: str = ""

    def __str__(self) -> str:
        if self.executable:
            return f"{self.kind} '{self.name}' has no executable '{self.executable}' here"
        return f"{self.kind} '{self.name}' is missing"


class Step:
    """One thing that a description does."""


@dataclass(frozen=True)
class ParameterValues:
    """An argument of a process: the path of a parameter file that is written when it starts."""

    content: dict[str, Any]


@dataclass(frozen=True)
class Process(Step):
    """A process to be started."""

    action: Any
    """The action in the description, by which event handlers refer to the process."""
    name: str
    argv: list[str | ParameterValues]
    env: dict[str, str]
    cwd: str | None
    where: str
    node_name: str | None = None
    """The full name of its node, if known."""
    shell: bool = False
    respawn: bool = False
    respawn_delay_sec: float = 0.0
    respawn_max_retries: int = -1
    output: str = "log"
    term_after_sec: float = 7.0
    """Time from SIGINT to SIGTERM."""
    kill_after_sec: float = 5.0
    """Time from SIGTERM to SIGKILL."""
    on_output: Callable[[bytes, int], object] | None = None
    """Called with its output; the second argument is 1 for standard output, 2 for errors."""
    emulate_tty: bool = False
    autostart: bool = False
    """Whether its managed node is configured and activated."""

    def changes(self, before: Mapping[str, str]) -> dict[str, str | None]:
        """Return the variables that differ from `before`; None for removed ones."""
        changed: dict[str, str | None] = {
            name: value for name, value in self.env.items() if before.get(name) != value
        }
        return changed | {name: None for name in before if name not in self.env}


@dataclass(frozen=True)
class Component:
    """A node of a container."""

    plugin: str
    package: str
    name: str | None
    namespace: str | None
    parameters: dict[str, Any]
    remappings: list[tuple[str, str]]
    extra_arguments: dict[str, Any] = field(default_factory=dict)

    @property
    def is_aionode(self) -> bool:
        """Whether it is a Python class, given as ``module:Class``."""
        return ":" in self.plugin and "::" not in self.plugin


@dataclass(frozen=True)
class LoadNodes(Step):
    """Nodes to load into a container."""

    container: str
    components: list[Component]
    where: str


@dataclass(frozen=True)
class Timer(Step):
    """Entities that are executed later."""

    action: Any
    period_sec: float
    entities: list[Any]
    context: Any
    is_canceled: Callable[[], bool]


@dataclass(frozen=True)
class Call(Step):
    """A coroutine that runs alongside the processes."""

    action: Any
    context: Any
    run: Callable[[Any], Awaitable[None]]

    @property
    def text(self) -> str:
        """The function that is called, as text."""
        return str(self.action.describe())


@dataclass(frozen=True)
class Completed(Step):
    """An action has been evaluated; it completes when everything it started has ended."""

    action: Any


@dataclass(frozen=True)
class Watch(Step):
    """An event handler that is registered or unregistered."""

    handler: Any
    context: Any
    entities: list[Any] | None = None
    """What is executed for any event; None if a function decides."""
    ends: bool = False


@dataclass(frozen=True)
class Emit(Step):
    """An event for the handlers."""

    event: Any


@dataclass(frozen=True)
class Opaque(Step):
    """An action that is unknown until it is executed; the rest may depend on it."""

    text: str


@dataclass(frozen=True)
class Log(Step):
    """A text for the user."""

    text: str
    level: str = "INFO"
