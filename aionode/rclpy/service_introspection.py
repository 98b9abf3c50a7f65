"""What services tell of their calls on ``<service>/_service_event``."""

from aionode.endpoints.service_introspection import ServiceIntrospectionState

__all__ = ["ServiceIntrospectionState"]
