"""Actions that wait, react to events, or log."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from aionode.launch.plan import Log, Timer
from launch.action import Action
from launch.event import Event
from launch.event_handler import BaseEventHandler
from launch.events import Shutdown as ShutdownEvent
from launch.launch_context import LaunchContext
from launch.substitution import (
    SomeSubstitutionsType,
    normalize_to_list_of_substitutions,
    perform_substitutions,
    text_of,
)

__all__ = [
    "EmitEvent",
    "LogInfo",
    "RegisterEventHandler",
    "Shutdown",
    "TimerAction",
    "UnregisterEventHandler",
]


class EmitEvent(Action):
    """Passes an event to the handlers."""

    def __init__(self, *, event: Event, **options: Any) -> None:
        super().__init__(**options)
        if not isinstance(event, Event):
            raise TypeError(f"EmitEvent: event= is {event!r}; use an event of launch.events")
        self.event = event

    def execute(self, context: LaunchContext) -> None:
        """Pass the event on."""
        context.emit_event_sync(self.event)


class Shutdown(EmitEvent):
    """Stops everything."""

    def __init__(
        self, *, reason: SomeSubstitutionsType = "reason not given", **options: Any
    ) -> None:
        text = reason if isinstance(reason, str) else "reason not given"
        super().__init__(event=ShutdownEvent(reason=text), **options)
        self.reason = normalize_to_list_of_substitutions(reason)

    def execute(self, context: LaunchContext) -> None:
        """Pass the request on."""
        reason = perform_substitutions(context, self.reason)
        context.emit_event_sync(ShutdownEvent(reason=reason))


class LogInfo(Action):
    """Writes a text to the log."""

    _LogInfo__level = "INFO"

    def __init__(self, *, msg: SomeSubstitutionsType, **options: Any) -> None:
        super().__init__(**options)
        self.msg = normalize_to_list_of_substitutions(msg)

    def execute(self, context: LaunchContext) -> None:
        """Log the text."""
        context.steps.append(Log(perform_substitutions(context, self.msg), self._LogInfo__level))


class RegisterEventHandler(Action):
    """Registers a handler, which is called whenever its event happens."""

    def __init__(self, event_handler: BaseEventHandler, **options: Any) -> None:
        super().__init__(**options)
        self.event_handler = event_handler

    def execute(self, context: LaunchContext) -> None:
        """Register the handler."""
        context.register_event_handler(self.event_handler)


class UnregisterEventHandler(Action):
    """Unregisters a handler."""

    def __init__(self, event_handler: BaseEventHandler, **options: Any) -> None:
        super().__init__(**options)
        self.event_handler = event_handler

    def execute(self, context: LaunchContext) -> None:
        """Unregister the handler."""
        context.unregister_event_handler(self.event_handler)


class TimerAction(Action):
    """Executes actions after a delay."""

    def __init__(
        self,
        *,
        period: float | SomeSubstitutionsType,
        actions: Iterable[Any],
        cancel_on_shutdown: Any = True,
        **options: Any,
    ) -> None:
        super().__init__(**options)
        self.period = period
        self.actions = list(actions)
        self._TimerAction__cancel_on_shutdown = cancel_on_shutdown
        self._TimerAction__is_canceled = False

    def cancel(self) -> None:
        """Cancel the timer, unless it has already fired."""
        self._TimerAction__is_canceled = True

    def _TimerAction__canceled(self) -> bool:
        """Return whether it was cancelled."""
        return self._TimerAction__is_canceled

    def execute(self, context: LaunchContext) -> None:
        """Start to wait."""
        period = self.period
        if not isinstance(period, int | float):
            period = text_of(context, period)
        later = context.fork()
        context.steps.append(
            Timer(self, float(period), self.actions, later, self._TimerAction__canceled)
        )
