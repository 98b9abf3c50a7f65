"""Publishes the calls of services on ``<service>/_service_event``."""

from aionode.engine.rules.service_events import ServiceIntrospectionState

__all__ = ["ServiceIntrospectionState"]
