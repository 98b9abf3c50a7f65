"""`launch.launch_context`: the state in which a description is evaluated."""

from __future__ import annotations

import asyncio
import os
from collections.abc import Callable, Iterable, Mapping
from types import SimpleNamespace
from typing import Any, Self

from aionode._packages import Packages
from aionode.launch.plan import Emit, Missing, Step, Watch

__all__ = ["KnownLater", "LaunchContext"]


class KnownLater(Exception):  # noqa: N818  # no error
    """A value is known only when the entity is actually executed: it may have changed by then."""


def cannot_load(path: str, kind: str) -> Any:
    """Refuse to load a file, which only an evaluation can do."""
    raise NotImplementedError(f"{path}: this context does not read launch files")


class Unknown:
    """Stands for a value known only at run time: an event, and everything that belongs to it."""

    def __init__(self, name: str) -> None:
        self._name = name

    def __getattr__(self, name: str) -> Unknown:
        return Unknown(f"{self._name}.{name}")

    def __str__(self) -> str:
        return f"<{self._name}>"


class LaunchContext:
    """The launch configurations, the environment, and the steps found so far.

    The environment is a copy: nothing changes that of this process. Substitutions, events and
    handlers depend on this class, so it does not depend on them.
    """

    def __init__(self, *, argv: Iterable[str] | None = None, noninteractive: bool = False) -> None:
        self.argv = list(argv or ())
        self.noninteractive = noninteractive
        self.launch_configurations: dict[str, Any] = {}
        self.environment: dict[str, str] = dict(os.environ)
        self.first_environment = dict(self.environment)
        """The environment when the launch began; launch files may change `environment`."""
        self.locals = SimpleNamespace()
        self.is_shutdown = False
        self.steps: list[Step] = []
        self.load_file: Callable[[str, str], Any] = cannot_load
        """Returns the description in a file, by its path and kind: python, xml, yaml or any."""
        self.packages = Packages()
        """The packages in which to look for executables and files."""
        self.declared: set[str] = set()
        """The arguments that have been declared."""
        self.skips_missing = False
        """Whether to leave out what needs a missing package; otherwise that is an error, unless
        it is a window."""
        self.left_out: dict[Missing, list[Any]] = {}
        """The entities left out because something is missing."""
        self.ahead = False
        """Whether the entities being evaluated are executed later."""
        self.visited = 0
        """Number of entities visited by the current evaluation."""
        self.names: dict[str, int] = {}
        """The number of processes with each name so far."""
        self._configurations: list[dict[str, Any]] = []
        self._environments: list[dict[str, str]] = []
        self._locals: list[dict[str, Any]] = []

    def fork(self, *, ahead: bool = False) -> Self:
        """Return a context without steps, for entities that are executed later.

        It shares its state with this one, so that it sees later declarations and settings in the
        same scope.

        Args:
            ahead: Whether they are evaluated in advance, to find mistakes.
        """
        later = type(self)(argv=self.argv, noninteractive=self.noninteractive)
        later.launch_configurations = self.launch_configurations
        later.environment = self.environment
        later.first_environment = self.first_environment
        later.locals = SimpleNamespace(**vars(self.locals))
        later.load_file = self.load_file
        later.packages = self.packages
        later.names = self.names  # one count for the whole description
        later.declared = self.declared
        later.skips_missing = self.skips_missing
        later.left_out = self.left_out
        later.ahead = ahead or self.ahead
        if ahead:  # it changes nothing for entities that are executed
            later.launch_configurations = dict(self.launch_configurations)
            later.environment = dict(self.environment)
            later.locals.event = Unknown("event")
        return later

    @property
    def asyncio_loop(self) -> asyncio.AbstractEventLoop:
        """The event loop.

        Raises:
            RuntimeError: The description is being evaluated, and nothing runs yet.
        """
        return asyncio.get_running_loop()

    def perform_substitution(self, sub: Any) -> str:
        """Return the text of a substitution."""
        return str(sub.perform(self))

    def extend_locals(self, extensions: Mapping[str, Any]) -> None:
        """Add values that later entities find in `locals`."""
        vars(self.locals).update(extensions)

    def need_present(self, what: str) -> None:
        """Give up if this is evaluated in advance.

        Raises:
            KnownLater: It is evaluated in advance.
        """
        if self.ahead:
            raise KnownLater(what)

    def get_locals_as_dict(self) -> dict[str, Any]:
        """Return the values in `locals`."""
        return dict(vars(self.locals))

    def push_locals(self) -> None:
        """Save the values in `locals` until the matching pop."""
        self._locals.append(self.get_locals_as_dict())

    def pop_locals(self) -> None:
        """Restore the values that the matching push saved."""
        self.locals = SimpleNamespace(**self._locals.pop())

    def push_launch_configurations(self) -> None:
        """Save the launch configurations until the matching pop."""
        self._configurations.append(self.launch_configurations)
        self.launch_configurations = dict(self.launch_configurations)

    def pop_launch_configurations(self) -> None:
        """Restore the launch configurations that the matching push saved."""
        self.launch_configurations = self._configurations.pop()

    def push_environment(self) -> None:
        """Save the environment until the matching pop."""
        self._environments.append(self.environment)
        self.environment = dict(self.environment)

    def pop_environment(self) -> None:
        """Restore the environment that the matching push saved."""
        self.environment = self._environments.pop()

    def reset_environment(self) -> None:
        """Reset the environment to its state when the launch began."""
        self.environment.clear()
        self.environment.update(self.first_environment)

    def register_event_handler(self, event_handler: Any, append: bool = False) -> None:
        """Register a handler."""
        known = event_handler._BaseEventHandler__known_entities()
        self.steps.append(Watch(event_handler, self.fork(), known))

    def unregister_event_handler(self, event_handler: Any) -> None:
        """Unregister a handler."""
        self.steps.append(Watch(handler=event_handler, context=self.fork(), ends=True))

    def emit_event_sync(self, event: Any) -> None:
        """Pass an event to the handlers."""
        self.steps.append(Emit(event=event))

    async def emit_event(self, event: Any) -> None:
        """Pass an event to the handlers."""
        self.emit_event_sync(event)

    def unique_name(self, name: str) -> str:
        """Return a name for one more process: the name and a number, as in ros2 launch."""
        number = self.names[""] = self.names.get("", 0) + 1
        return f"{name}-{number}"
