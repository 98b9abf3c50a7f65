"""Between processes and machines: messages travel through Zenoh, as rmw_zenoh_cpp sends them.

Zenoh's threads only append what arrives to a queue and wake the event loop (`_loop_waker`);
everything else happens on the loop. What may block while sending goes through a thread
(`_send_thread`).
"""

from aionode.engine.transport.zenoh._transport import ZenohTransport

__all__ = ["ZenohTransport"]
