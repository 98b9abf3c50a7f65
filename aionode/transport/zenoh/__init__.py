"""The transport over Zenoh; see `aionode.engine.transport.zenoh`."""

from aionode.engine.transport.zenoh import ZenohTransport

__all__ = ["ZenohTransport"]
