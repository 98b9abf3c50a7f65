"""What is called when something happens to a publisher or subscription itself."""

from __future__ import annotations

from typing import Any

__all__ = ["PublisherEventCallbacks", "SubscriptionEventCallbacks"]

EventHandler = Any


class SubscriptionEventCallbacks:
    """Callbacks of a subscription."""

    def __init__(self, **callbacks: Any) -> None:
        self.callbacks = callbacks

    def create_event_handlers(self, group: Any, handle: Any, topic: str) -> list[EventHandler]:
        """Return the handlers."""
        return []


class PublisherEventCallbacks(SubscriptionEventCallbacks):
    """Callbacks of a publisher."""
