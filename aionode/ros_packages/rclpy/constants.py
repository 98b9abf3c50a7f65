"""Constants."""

from aionode.clock import S_TO_NS

__all__ = ["S_TO_NS"]
