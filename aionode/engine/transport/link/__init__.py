"""A transport between processes of one user on one host: a Unix socket in the event loop.

It works next to Zenoh, which discovers the processes and carries messages to all others. See "Link"
in docs/design.md.
"""

from aionode.engine.transport.link._endpoint_table import can_link
from aionode.engine.transport.link._listener import Advertisement, available
from aionode.engine.transport.link._transport import LinkTransport

__all__ = ["Advertisement", "LinkTransport", "available", "can_link"]
