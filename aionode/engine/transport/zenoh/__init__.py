"""The transport between processes and machines over Zenoh, compatible with rmw_zenoh_cpp.

Zenoh's threads only append arriving data to a queue and wake the event loop (`loop_waker`);
everything else happens on the loop. Sends that may block go through a thread (`send_thread`).
"""

from aionode.engine.transport.zenoh._transport import ZenohTransport

__all__ = ["ZenohTransport"]
