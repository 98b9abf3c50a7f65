"""The transport over the ROS 2 that is installed; see `aionode.engine.transport.rcl`."""

from aionode.engine.transport.rcl import RclTransport

__all__ = ["RclTransport"]
