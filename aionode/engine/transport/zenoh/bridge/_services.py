"""Servers and clients for the nodes behind bridges."""

from __future__ import annotations

from typing import ClassVar

import zenoh

from aionode.engine.transport.base import SampleInfo
from aionode.engine.transport.zenoh.bridge._state import BridgeDeclaration
from aionode.engine.transport.zenoh.delivery.delivery import UNKNOWN_GID, sample_info_of
from aionode.engine.transport.zenoh.endpoints.services import ZenohRequester, ZenohServer
from aionode.engine.wire._bridge import parse_request_id
from aionode.errors import FAST_DDS_REMEDY, FAST_DDS_SILENCE

__all__ = ["BridgeRequester", "BridgeServer"]


class BridgeServer(BridgeDeclaration, ZenohServer):
    """A server as seen by the clients behind bridges.

    DDS has no errors: if a handler fails, the client gets no answer.
    """

    def _receive(self, query: zenoh.Query) -> None:
        extra = query.attachment
        if query.payload is None or sample_info_of(extra) is not None:
            # Not a request, or one from an aionode context, which also arrives on rmw_zenoh's key.
            self.answer(query, sample_info_of(extra) or SampleInfo(UNKNOWN_GID, 0, 0), None, 0)
            return
        request = None if extra is None else parse_request_id(extra.to_bytes())
        client, sequence = request or (UNKNOWN_GID, 0)
        self._receive_from(query, SampleInfo(client, sequence, 0))

    def attachment_of(self, sample_info: SampleInfo) -> None:
        """Return None: responses through a bridge have no attachment."""

    def refuse(self, query: zenoh.Query, sample_info: SampleInfo, problem: bytes) -> None:  # noqa: ARG002  # a bridge takes only responses
        """End `query` without an answer."""
        self.answer(query, sample_info, None, 0)

    def cancel(self, gid: bytes, sequence: int) -> None:
        """Do nothing: DDS clients do not cancel."""


class BridgeRequester(BridgeDeclaration, ZenohRequester):
    """A client as seen by the servers behind bridges."""

    # A bridge's queryable is not complete. Those of other contexts ignore this request.
    target: ClassVar[zenoh.QueryTarget] = zenoh.QueryTarget.ALL

    @property
    def caveat(self) -> str:
        """Why the matched servers may not answer: those on Fast DDS never do."""
        if self.participants() & self.bridges.fast_dds:
            return f"{FAST_DDS_SILENCE}: {FAST_DDS_REMEDY}"
        return ""

    def tell_cancelled(self, sequence: int) -> None:
        """Do nothing: DDS servers cannot be notified."""
