"""Over the ROS 2 that is installed: messages travel through rcl and whatever middleware it runs.

The only package that imports rclpy, and it does so when a context opens, since that takes half a
second. Everything asynchronous is signalled through eventfds: no Python runs in the middleware's
threads, and there is no executor.
"""

from aionode.engine.transport.rcl._transport import RclTransport

__all__ = ["RclTransport"]
