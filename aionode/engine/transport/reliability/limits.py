"""Limits that both ends of the protocol know."""

from __future__ import annotations

from typing import Final

__all__ = ["NEVER", "OVERHEAD_BYTES", "QUIET_NS", "WINDOW_BYTES", "WINDOW_MESSAGES"]

WINDOW_BYTES: Final = 512 * 1024
"""How many bytes a writer sends ahead of a reader's acknowledgement."""

WINDOW_MESSAGES: Final = 4
"""Number of messages that may be unacknowledged whatever their size."""

OVERHEAD_BYTES: Final = 128
"""Approximate overhead of a message besides its payload, in bytes."""

QUIET_NS: Final = 50_000_000
"""A writer that has sent nothing for this long sends a heartbeat."""

NEVER: Final = 1 << 62
"""A sequence number, size or time in nanoseconds that is never reached."""
