"""Constants of the encoding that do not depend on message types."""

from __future__ import annotations

__all__ = ["COUNT_SIZE", "HEADER", "NOTHING"]

HEADER = b"\x00\x01\x00\x00"
"""Encapsulation header of every message: CDR, little endian, no options."""

COUNT_SIZE = 4
"""Size in bytes of the uint32 length of strings and sequences."""

NOTHING = memoryview(b"")
"""The memoryview of an empty sequence, as Python casts none without elements."""
