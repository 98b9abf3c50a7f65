"""The counterparts of one endpoint: which are matched, and which are incompatible."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from aionode.engine.rules.event_records import (
    IncompatibleTypeInfo,
    MatchedInfo,
    QoSRequestedIncompatibleQoSInfo,
)

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.graph import EndpointInfo

__all__ = ["Matching"]


class Matching:
    """Counts matched and incompatible counterparts, and reports each change.

    Args:
        endpoint: The endpoint.
        emit: Called with the name of an event and the event.
    """

    def __init__(self, endpoint: EndpointInfo, emit: Callable[[str, Any], None]) -> None:
        self._endpoint = endpoint
        self._emit = emit
        self._matched: set[EndpointInfo] = set()
        self._total = 0
        self._incompatible_qos = 0
        self._incompatible_types = 0

    def note(self, other: EndpointInfo, present: bool) -> None:
        """Record a counterpart that has appeared or left."""
        if present:
            self._add(other)
        elif other in self._matched:
            self._matched.remove(other)
            self._emit("matched", MatchedInfo(self._total, 0, len(self._matched), -1))

    def _add(self, other: EndpointInfo) -> None:
        mismatch = self._endpoint.compare(other)
        if mismatch is not None and mismatch.aspect == "qos":
            self._incompatible_qos += 1
            self._emit(
                "incompatible_qos",
                QoSRequestedIncompatibleQoSInfo(self._incompatible_qos, 1, mismatch.policy),
            )
        elif mismatch is not None:
            self._incompatible_types += 1
            self._emit("incompatible_type", IncompatibleTypeInfo(self._incompatible_types, 1))
        # rmw_zenoh delivers messages whatever the QoS is, so that is a match, too.
        if self._endpoint.matches(other) and other not in self._matched:
            self._matched.add(other)
            self._total += 1
            self._emit("matched", MatchedInfo(self._total, 1, len(self._matched), 1))
