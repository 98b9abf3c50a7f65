"""`launch.event`: events while a system runs."""

from __future__ import annotations

__all__ = ["Event"]


class Event:
    """Something that happened, or a request."""

    name = "launch.Event"
