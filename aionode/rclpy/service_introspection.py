"""What services tell of their calls on ``<service>/_service_event``."""

from aionode.rclpy.impl._introspection import ServiceIntrospectionState

__all__ = ["ServiceIntrospectionState"]
