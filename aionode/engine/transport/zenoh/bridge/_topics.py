"""Publishers and subscriptions for the nodes behind bridges."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

import zenoh

from aionode.engine.transport.base import SampleInfo
from aionode.engine.transport.zenoh.bridge._state import BridgeDeclaration
from aionode.engine.transport.zenoh.delivery.delivery import (
    UNKNOWN_GID,
    is_transient,
    sample_info_of,
)
from aionode.engine.transport.zenoh.endpoints.publisher import ZenohWriter
from aionode.engine.transport.zenoh.endpoints.subscription import ZenohReader
from aionode.qos import is_unlimited

if TYPE_CHECKING:
    from aionode.graph import EndpointInfo
    from aionode.qos import QoSProfile

__all__ = ["BridgeReader", "BridgeWriter", "keeps_for_late_readers"]


def keeps_for_late_readers(qos: QoSProfile) -> bool:
    """Return whether messages published without a bridge are kept for the first one.

    Not if they have a lifespan, like the log.
    """
    return is_transient(qos) and is_unlimited(qos.lifespan)


class BridgeWriter(BridgeDeclaration, ZenohWriter):
    """A publisher for subscriptions behind bridges.

    Its messages have rmw_zenoh's attachment, which bridges ignore; it tells other aionode contexts
    that they also get the message on the other key.
    """

    recovers: ClassVar[bool] = False

    def _update(self, reader: EndpointInfo | None = None, present: bool = True) -> None:
        """Update `active` from the subscriptions that bridges announce."""
        super()._update(reader, present)
        if self._transient:
            self.active = self.sender.publisher is not None or keeps_for_late_readers(
                self.endpoint.qos
            )

    def assert_liveliness(self) -> None:
        """Do nothing: bridges do not transmit it."""

    def route_of(self, reader: EndpointInfo) -> str | None:
        """Return ``bridge`` for subscriptions behind one."""
        return "bridge" if reader.node.bridged else None


class BridgeReader(BridgeDeclaration, ZenohReader):
    """A subscription to publishers behind bridges."""

    recovers: ClassVar[bool] = False

    def _receive(self, sample: zenoh.Sample) -> None:
        if sample.kind != zenoh.SampleKind.PUT or sample_info_of(sample.attachment) is not None:
            return  # from an aionode context, whose message also comes on rmw_zenoh's key
        payload = sample.payload.to_bytes()
        sample_info = SampleInfo(UNKNOWN_GID, 0, 0)
        if self._keep_all:
            self._accept_or_wait(payload, sample_info, None)
        else:
            self._hand_over(payload, sample_info)
