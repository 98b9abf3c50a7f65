"""Undeclaring a publisher with heartbeats may stop all Python threads for ten seconds.

Zenoh:
    `undeclare` of an AdvancedPublisher waits with the GIL held for the task that sends its
    heartbeats. If a subscriber of the same process hears these in a callback that Zenoh's thread
    calls directly, that task waits for the GIL, until Zenoh gives up after ten seconds.
Known as:
    Not reported.
Seen in:
    1.8.0, 1.9.0, 1.10.2
Mend:
    Publishers of histories have no heartbeats (`declare_keeping` in `_kept_history`). Heartbeats
    would tell readers of a missing last message too: `_acknowledgements` do so for KEEP_ALL.
"""

from __future__ import annotations

from zenoh import ext

from aionode.engine.transport.zenoh._defects._switch import is_mended

__all__ = ["miss_detection"]

HEARTBEAT_S = 0.5
"""The interval of heartbeats without this workaround, in seconds."""


def miss_detection() -> ext.MissDetectionConfig:
    """Return the setting by which a publisher numbers its messages."""
    heartbeat = None if is_mended("heartbeats") else HEARTBEAT_S
    return ext.MissDetectionConfig(heartbeat=heartbeat, sporadic_heartbeat=None)
