"""A reader never releases the shared memory of a peer that has ended.

Zenoh:
    A process that reads shared memory keeps each segment that it has attached, with two descriptors
    and two mappings, until it ends: 1000 restarts of a publisher leave 2000 descriptors.
Reported:
    https://github.com/eclipse-zenoh/zenoh/issues/2787,
    https://github.com/eclipse-zenoh/zenoh/issues/1700
Seen in:
    1.8.0, 1.9.0, 1.10.2
Workaround:
    Zenoh's shared memory is switched off. Links have their own; processes of other users cannot
    open Zenoh's, and ROS 2 nodes have it switched off.
"""

from __future__ import annotations

from aionode.engine.transport.zenoh._defects._switch import is_mended

__all__ = ["settings"]


def settings() -> dict[str, object]:
    """Return settings of sessions and routers that work around this."""
    return {"transport/shared_memory/enabled": False} if is_mended("shared_memory") else {}
