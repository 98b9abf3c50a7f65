"""`launch.event_handler`: reactions to events."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any

from launch.event import Event
from launch.launch_description_entity import LaunchDescriptionEntity

if TYPE_CHECKING:
    from launch.launch_context import LaunchContext

__all__ = ["BaseEventHandler", "EventHandler", "entities_of"]


def entities_of(result: Any) -> list[LaunchDescriptionEntity]:
    """Return the entities that a function or a visit returned: none, one or several."""
    if result is None:
        return []
    if isinstance(result, LaunchDescriptionEntity):
        return [result]
    if not isinstance(result, Iterable):
        raise TypeError(f"expected launch actions, got {result!r}")
    entities: list[LaunchDescriptionEntity] = []
    for entity in result:
        if not isinstance(entity, LaunchDescriptionEntity):
            raise TypeError(f"expected launch actions, got {entity!r} among them")
        entities.append(entity)
    return entities


class BaseEventHandler:
    """Decides which events it handles, and how it reacts.

    Args:
        matcher: Returns whether it handles an event.
        handle_once: Whether it handles one event only.
        reaction: Entities; or a function of the event and the context, which returns some.
    """

    def __init__(
        self, *, matcher: Callable[[Event], bool], handle_once: bool = False, reaction: Any = None
    ) -> None:
        self._BaseEventHandler__matcher = matcher
        self.handle_once = handle_once
        self._BaseEventHandler__function: Callable[..., Any] | None = (
            reaction if callable(reaction) else None
        )
        self._BaseEventHandler__entities = None if callable(reaction) else entities_of(reaction)

    def matches(self, event: Event) -> bool:
        """Return whether an event concerns this handler."""
        return bool(self._BaseEventHandler__matcher(event))

    def handle(self, event: Event, context: LaunchContext) -> Any:
        """Handle the event, and return the entities to execute, or None."""
        context.extend_locals({"event": event})
        if self.handle_once:
            context.unregister_event_handler(self)
        return (
            self._BaseEventHandler__entities
            if self._BaseEventHandler__function is None
            else self._BaseEventHandler__function(event, context)
        )

    def _BaseEventHandler__known_entities(self) -> list[LaunchDescriptionEntity] | None:
        """Return the entities executed for any event; None if a function decides."""
        return self._BaseEventHandler__entities

    def describe(self) -> str:
        """Return the event that it reacts to, such as ``exit of talker-1``."""
        return f"an event of {type(self).__name__}"


class EventHandler(BaseEventHandler):
    """Executes the same entities at each matching event."""

    def __init__(
        self, *, matcher: Callable[[Event], bool], entities: Any = None, handle_once: bool = False
    ) -> None:
        super().__init__(matcher=matcher, handle_once=handle_once, reaction=entities)

    @property
    def entities(self) -> list[LaunchDescriptionEntity] | None:
        """The actions that the event triggers."""
        return self._BaseEventHandler__entities
