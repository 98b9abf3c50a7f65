"""Between processes of one user on one host: a Unix socket read by the event loop itself.

It stands beside Zenoh, which finds the processes and carries everything to everybody else. See
"Link" in docs/design.md.
"""

from aionode.transport.link.meeting import available
from aionode.transport.link.transport import LinkTransport

__all__ = ["LinkTransport", "available"]
