"""`launch.event_handlers`."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from aionode.launch._launch.event import Event
from aionode.launch._launch.event_handler import BaseEventHandler, EventHandler, entities_of
from aionode.launch._launch.events import ExecutionComplete, Shutdown
from aionode.launch._launch.events.process import ProcessExited, ProcessIO, ProcessStarted
from aionode.launch._launch.launch_context import LaunchContext
from aionode.launch._launch.launch_description_entity import LaunchDescriptionEntity

__all__ = [
    "EventHandler",
    "OnActionEventBase",
    "OnExecutionComplete",
    "OnProcessExit",
    "OnProcessIO",
    "OnProcessStart",
    "OnShutdown",
]


class OnActionEventBase(BaseEventHandler):
    """Reacts to what happens to one action, to those that a function names, or to all."""

    happens = "an event"

    def __init__(
        self,
        *,
        action_matcher: Any,
        on_event: Any,
        target_event_cls: type[Event],
        target_action_cls: type = object,
        **options: Any,
    ) -> None:
        def matcher(event: Event) -> bool:
            if not isinstance(event, target_event_cls):
                return False
            action = getattr(event, "action", None)
            if action_matcher is None or action_matcher is action:
                return True
            is_test = callable(action_matcher) and not isinstance(
                action_matcher, LaunchDescriptionEntity
            )
            return is_test and bool(action_matcher(action))

        super().__init__(matcher=matcher, **options)
        self.action_matcher = action_matcher
        self._function: Callable[..., Any] | None = on_event if callable(on_event) else None
        self._entities = None if callable(on_event) else entities_of(on_event)

    def handle(self, event: Event, context: LaunchContext) -> Any:
        """Return the entities, or what the function returns."""
        super().handle(event, context)
        return self._entities if self._function is None else self._function(event, context)

    def known_entities(self) -> list[LaunchDescriptionEntity] | None:
        """Return the entities; None if there is a function."""
        return self._entities

    def describe(self) -> str:
        """Return what happens to whom."""
        target = self.action_matcher
        if target is None:
            return f"{self.happens} of any process"
        if isinstance(target, LaunchDescriptionEntity):
            return f"{self.happens} of {target.describe()}"
        return f"{self.happens} of what {getattr(target, '__name__', target)} names"


class OnProcessExit(OnActionEventBase):
    """Reacts to the end of a process."""

    happens = "exit"

    def __init__(self, *, target_action: Any = None, on_exit: Any, **options: Any) -> None:
        super().__init__(
            action_matcher=target_action,
            on_event=on_exit,
            target_event_cls=ProcessExited,
            **options,
        )


class OnProcessStart(OnActionEventBase):
    """Reacts to the start of a process."""

    happens = "start"

    def __init__(self, *, target_action: Any = None, on_start: Any, **options: Any) -> None:
        super().__init__(
            action_matcher=target_action,
            on_event=on_start,
            target_event_cls=ProcessStarted,
            **options,
        )


class OnExecutionComplete(OnActionEventBase):
    """Reacts to the end of an action."""

    happens = "completion"

    def __init__(self, *, target_action: Any = None, on_completion: Any, **options: Any) -> None:
        super().__init__(
            action_matcher=target_action,
            on_event=on_completion,
            target_event_cls=ExecutionComplete,
            **options,
        )


class OnProcessIO(OnActionEventBase):
    """Reacts to what a process writes."""

    happens = "output"

    def __init__(
        self,
        *,
        target_action: Any = None,
        on_stdin: Callable[[ProcessIO], Any] | None = None,
        on_stdout: Callable[[ProcessIO], Any] | None = None,
        on_stderr: Callable[[ProcessIO], Any] | None = None,
        **options: Any,
    ) -> None:
        def on_output(event: ProcessIO, context: LaunchContext) -> Any:
            if event.from_stdout and on_stdout is not None:
                return on_stdout(event)
            if event.from_stderr and on_stderr is not None:
                return on_stderr(event)
            return None

        super().__init__(
            action_matcher=target_action, on_event=on_output, target_event_cls=ProcessIO, **options
        )


class OnShutdown(BaseEventHandler):
    """Reacts to the request to stop everything."""

    def __init__(self, *, on_shutdown: Any, **options: Any) -> None:
        super().__init__(matcher=lambda event: isinstance(event, Shutdown), **options)
        self._function = on_shutdown if callable(on_shutdown) else None
        self._entities = None if callable(on_shutdown) else entities_of(on_shutdown)

    def handle(self, event: Event, context: LaunchContext) -> Any:
        """Return the entities, or what the function returns."""
        super().handle(event, context)
        return self._entities if self._function is None else self._function(event, context)

    def known_entities(self) -> list[LaunchDescriptionEntity] | None:
        """Return the entities; None if there is a function."""
        return self._entities

    def describe(self) -> str:
        """Return what happens."""
        return "shutdown"
