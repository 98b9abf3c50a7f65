"""Service introspection: each end of a call tells of it on ``<service>/_service_event``."""

from __future__ import annotations

from enum import IntEnum

__all__ = ["ServiceIntrospectionState"]


class ServiceIntrospectionState(IntEnum):
    """What is told of a call."""

    OFF = 0
    METADATA = 1
    CONTENTS = 2
