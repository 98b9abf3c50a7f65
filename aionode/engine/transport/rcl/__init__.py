"""A transport over the installed ROS 2: messages travel through rcl and its middleware.

This is the only package that imports rclpy, and only when a context opens, since that takes half a
second. Everything asynchronous is signalled through eventfds: no Python runs in the middleware's
threads, and there is no executor.
"""

from aionode.engine.transport.rcl._transport import RclTransport

__all__ = ["RclTransport"]
