"""Undeclaring a publisher with heartbeats may stop all Python threads for ten seconds.

Zenoh:
    `undeclare` of an AdvancedPublisher holds the GIL while it waits for the task that sends its
    heartbeats. If a subscriber of the same process receives these in a callback that Zenoh's thread
    calls directly, that task waits for the GIL, until Zenoh gives up after ten seconds.
Reported:
    No.
Seen in:
    1.8.0, 1.9.0, 1.10.2
Workaround:
    Publishers with a history have no heartbeats (`declare_keeping` in `kept_history`). Heartbeats
    would also tell readers that the last message is missing: `acknowledgements` does so for
    KEEP_ALL.
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
