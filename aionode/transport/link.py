"""The transport of one host; see `aionode.engine.transport.link`."""

from aionode.engine.transport.link import Advertisement, LinkTransport, available, can_link

__all__ = ["Advertisement", "LinkTransport", "available", "can_link"]
