"""The class `Node`, which programs instantiate or subclass."""

from aionode.node._node import Node, direct_subscription, parts_subscription

__all__ = ["Node", "direct_subscription", "parts_subscription"]
