"""Publishes the calls of services on ``<service>/_service_event``."""

from aionode.engine.rules.service_events import ServiceIntrospectionState
from rclpy._reexports import add_names

__all__ = ["ServiceIntrospectionState"]

add_names(__name__)
