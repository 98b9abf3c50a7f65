"""Between processes of one user on one host: a Unix socket read by the event loop itself.

It stands beside Zenoh, which finds the processes and carries everything to everybody else. See
"Link" in docs/design.md.
"""

from aionode.transport.ipc._listener import Advertisement, available
from aionode.transport.ipc._protocol import can_link
from aionode.transport.ipc._transport import IpcTransport

__all__ = ["Advertisement", "IpcTransport", "available", "can_link"]
