"""Nodes without callbacks, for other APIs over aionode; see `aionode.engine.bare_node`."""

from aionode.engine.bare_node import (
    BareCall,
    BareClient,
    BareEndpoint,
    BareNode,
    BarePublisher,
)

__all__ = ["BareCall", "BareClient", "BareEndpoint", "BareNode", "BarePublisher"]
