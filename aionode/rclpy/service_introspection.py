"""Publishes the calls of services on ``<service>/_service_event``."""

from aionode.endpoints.service_introspection import ServiceIntrospectionState

__all__ = ["ServiceIntrospectionState"]
