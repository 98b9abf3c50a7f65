"""`Node`, which a program creates or derives from."""

from aionode.node._node import Node, direct_subscription

__all__ = ["Node", "direct_subscription"]
