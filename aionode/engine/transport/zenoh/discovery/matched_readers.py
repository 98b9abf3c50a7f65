"""The readers of one publisher in other contexts, and what they need."""

from __future__ import annotations

from typing import TYPE_CHECKING

from aionode.graph import EndpointKind
from aionode.qos import ReliabilityPolicy

if TYPE_CHECKING:
    from aionode.engine.transport.zenoh._session_state import SessionState
    from aionode.graph import EndpointInfo, Graph

__all__ = ["MatchedReaders"]


class MatchedReaders:
    """The matched readers of one publisher.

    Readers are added and removed one at a time, so that with many publishers and subscriptions of a
    topic each pair is compared only once.

    Args:
        endpoint: The publisher.
        state: The state of the session.

    Attributes:
        participants: The context of each reader, by gid.
        acknowledging: Readers that acknowledge, each with its context.
        others: Readers of contexts that do not acknowledge, whatever their reliability, and readers
            that never have, though their contexts claim to.
    """

    def __init__(self, endpoint: EndpointInfo, state: SessionState) -> None:
        self.participants: dict[bytes, str] = {}
        self.acknowledging: dict[bytes, str] = {}
        self.others: set[bytes] = set()
        self._mute: set[bytes] = set()
        self._had_mute = False
        self._endpoint = endpoint
        self._state = state

    def update(self, graph: Graph, reader: EndpointInfo | None, *, present: bool) -> None:
        """Handle a reader that has appeared or vanished; None to find all of them."""
        if reader is None:
            self.participants.clear()
            self.others.clear()
            self.acknowledging.clear()
            for known in graph.endpoints(EndpointKind.SUBSCRIPTION, name=self._endpoint.name):
                self._add(known)
            self._mute &= self.participants.keys()
        else:
            self.participants.pop(reader.gid, None)
            self.others.discard(reader.gid)
            self.acknowledging.pop(reader.gid, None)
            if present:
                self._add(reader)
            else:
                self._mute.discard(reader.gid)

    def _add(self, reader: EndpointInfo) -> None:
        if not (self._state.reaches(reader.node) and self._endpoint.matches(reader)):
            return
        participant = self.participants[reader.gid] = reader.node.participant
        acknowledges = participant in self._state.acknowledgements.participants
        if not acknowledges or reader.gid in self._mute:
            self.others.add(reader.gid)
        elif reader.qos.resolved().reliability is ReliabilityPolicy.RELIABLE:
            self.acknowledging[reader.gid] = participant

    def note_mute(self, gid: bytes) -> bool:
        """Count a reader among the others, as it has never acknowledged anything.

        Returns whether this is the first such reader.
        """
        is_first, self._had_mute = not self._had_mute, True
        if self.acknowledging.pop(gid, None) is not None:
            self._mute.add(gid)
            self.others.add(gid)
        return is_first

    def note_heard(self, gid: bytes) -> bool:
        """Record an acknowledgement; return whether it is the first one of a mute reader.

        If so, all readers have to be determined again.
        """
        if gid not in self._mute:
            return False
        self._mute.discard(gid)
        return True
