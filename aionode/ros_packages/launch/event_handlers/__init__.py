"""`launch.event_handlers`."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from launch.event import Event
from launch.event_handler import BaseEventHandler, EventHandler
from launch.events import ExecutionComplete, Shutdown
from launch.events.process import ProcessExited, ProcessIO, ProcessStarted
from launch.launch_context import LaunchContext
from launch.launch_description_entity import LaunchDescriptionEntity

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
    """Reacts to events of one action, of those that a function selects, or of all."""

    _OnActionEventBase__happens = "an event"

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

        super().__init__(matcher=matcher, reaction=on_event, **options)
        self._OnActionEventBase__action_matcher = action_matcher

    def describe(self) -> str:
        """Return a description of the event and its target."""
        target, happens = self._OnActionEventBase__action_matcher, self._OnActionEventBase__happens
        if target is None:
            return f"{happens} of any process"
        if isinstance(target, LaunchDescriptionEntity):
            return f"{happens} of {target.describe()}"
        return f"{happens} of what {getattr(target, '__name__', target)} names"


class OnMoment(OnActionEventBase):
    """Reacts to a moment in the life of an action, selected by the argument with its name."""

    _OnMoment__argument = ""
    _OnMoment__event_cls: type[Event]

    def __init__(self, *, target_action: Any = None, **options: Any) -> None:
        if self._OnMoment__argument not in options:
            raise TypeError(f"{type(self).__name__} needs {self._OnMoment__argument}=")
        reaction = options.pop(self._OnMoment__argument)
        super().__init__(
            action_matcher=target_action,
            on_event=reaction,
            target_event_cls=self._OnMoment__event_cls,
            **options,
        )


class OnProcessExit(OnMoment):
    """Reacts to the end of a process, with ``on_exit=``."""

    _OnActionEventBase__happens, _OnMoment__argument, _OnMoment__event_cls = (
        "exit",
        "on_exit",
        ProcessExited,
    )


class OnProcessStart(OnMoment):
    """Reacts to the start of a process, with ``on_start=``."""

    _OnActionEventBase__happens, _OnMoment__argument, _OnMoment__event_cls = (
        "start",
        "on_start",
        ProcessStarted,
    )


class OnExecutionComplete(OnMoment):
    """Reacts to the completion of an action, with ``on_completion=``."""

    _OnActionEventBase__happens, _OnMoment__argument, _OnMoment__event_cls = (
        "completion",
        "on_completion",
        ExecutionComplete,
    )


class OnProcessIO(OnActionEventBase):
    """Reacts to the output of a process."""

    _OnActionEventBase__happens = "output"

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
        super().__init__(
            matcher=lambda event: isinstance(event, Shutdown), reaction=on_shutdown, **options
        )

    def describe(self) -> str:
        """Return a description of the event."""
        return "shutdown"
