"""Callback groups determine which callbacks of a node may run at the same time."""

from __future__ import annotations

import threading
import weakref
from typing import Any

__all__ = [
    "CallbackGroup",
    "Entity",
    "MutuallyExclusiveCallbackGroup",
    "ReentrantCallbackGroup",
]

Entity = Any
"""A subscription, timer, client, service, guard condition or waitable."""


class CallbackGroup:
    """The base class of groups.

    An executor asks `can_execute`, then calls the other two around a call.

    Attributes:
        entities: Weak references to its members.
    """

    def __init__(self) -> None:
        super().__init__()
        self.entities: set[weakref.ref[Any]] = set()

    def add_entity(self, entity: Entity) -> None:
        """Add an entity that is in no other group."""
        self.entities.add(weakref.ref(entity))

    def has_entity(self, entity: Entity) -> bool:
        """Return whether an entity is in this group."""
        return weakref.ref(entity) in self.entities

    def can_execute(self, entity: Entity) -> bool:
        """Return whether a call of the entity's callback may start now."""
        raise NotImplementedError

    def beginning_execution(self, entity: Entity) -> bool:
        """Begin a call, and return whether it may run."""
        raise NotImplementedError

    def ending_execution(self, entity: Entity) -> None:
        """End a call that had begun, whether it returned or raised."""
        raise NotImplementedError


class ReentrantCallbackGroup(CallbackGroup):
    """All its callbacks may run at the same time, including several calls of the same one."""

    def can_execute(self, entity: Entity) -> bool:
        """Return True."""
        return True

    def beginning_execution(self, entity: Entity) -> bool:
        """Return True."""
        return True

    def ending_execution(self, entity: Entity) -> None:
        """Do nothing."""


class MutuallyExclusiveCallbackGroup(CallbackGroup):
    """One of its callbacks runs at a time."""

    def __init__(self) -> None:
        super().__init__()
        self._active_entity: Entity | None = None
        # Held while a call begins or ends, so that only one thread begins. `can_execute` does not
        # need it, because executors ask `beginning_execution` before each call.
        self._lock = threading.RLock()

    def can_execute(self, entity: Entity) -> bool:
        """Return whether none of its callbacks is running."""
        return self._active_entity is None

    def beginning_execution(self, entity: Entity) -> bool:
        """Begin a call, if none is running."""
        with self._lock:
            if self._active_entity is None:
                self._active_entity = entity
                return True
        return False

    def ending_execution(self, entity: Entity) -> None:
        """End the call."""
        with self._lock:
            self._active_entity = None
