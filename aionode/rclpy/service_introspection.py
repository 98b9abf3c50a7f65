"""What services tell of their calls on ``<service>/_service_event``."""

from aionode.rclpy._impl.introspection import ServiceIntrospectionState

__all__ = ["ServiceIntrospectionState"]
