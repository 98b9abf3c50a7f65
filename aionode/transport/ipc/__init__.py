"""Messages between processes of one user on one host, over a Unix socket in the event loop.

It works beside Zenoh, which discovers the processes and carries messages to all others. See "Link"
in docs/design.md.
"""

from aionode.transport.ipc._endpoint_table import can_link
from aionode.transport.ipc._listener import Advertisement, available
from aionode.transport.ipc._transport import IpcTransport

__all__ = ["Advertisement", "IpcTransport", "available", "can_link"]
