"""The transport of one process; see `aionode.engine.transport.local`."""

from aionode.engine.transport.local import LocalTransport

__all__ = ["LocalTransport"]
