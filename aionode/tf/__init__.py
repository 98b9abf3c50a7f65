"""Transforms between coordinate frames."""

from __future__ import annotations

from aionode.tf._buffer_core import BufferCore

__all__ = ["BufferCore"]
