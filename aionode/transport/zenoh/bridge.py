"""The transport to bridges of DDS; see `aionode.engine.transport.zenoh.bridge`."""

from aionode.engine.transport.zenoh.bridge import BridgeTransport

__all__ = ["BridgeTransport"]
