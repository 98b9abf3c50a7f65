"""Warnings about simulated time that is missing or invalid."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

from aionode.clock import S_TO_NS
from aionode.graph import EndpointKind
from aionode.logging import get_logger
from aionode.names import logger_name

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.clock import Alarm, TimeBase
    from aionode.graph import EndpointInfo, Graph

__all__ = ["ClockWatch", "why_no_time"]

WAIT_S: Final = 5.0
"""How long to wait for simulated time before warning, in seconds: simulators start slowly."""


class ClockWatch:
    """Warns once if simulated time has not started, since stopped timers are otherwise silent.

    Args:
        subscription: The graph entry of the subscription to ``/clock``.
        graph: The graph.
        time_base: The time base of the context.
        heard: Whether a time has arrived.
    """

    def __init__(
        self,
        subscription: EndpointInfo,
        graph: Graph,
        time_base: TimeBase,
        heard: Callable[[], bool],
    ) -> None:
        self._subscription = subscription
        self._graph = graph
        self._time_base = time_base
        self._heard = heard
        self._alarm: Alarm | None = None

    def start(self) -> None:
        """Start waiting, on the event loop."""
        time_base = self._time_base
        ends_ns = time_base.steady_ns() + round(WAIT_S * S_TO_NS)
        self._alarm = time_base.call_at(ends_ns, self._look)

    def _look(self) -> None:
        node, name = self._subscription.node, self._subscription.name
        publishers = self._graph.endpoints(EndpointKind.PUBLISHER, name=name)
        known = self._graph.endpoints(EndpointKind.SUBSCRIPTION, name=name)
        if self._heard() or self._subscription not in known:
            return
        who = ", ".join({publisher.node.fully_qualified_name for publisher in publishers})
        why = f"{who} has published no time on {name}" if who else f"nobody publishes {name}"
        get_logger(logger_name(node.namespace, node.name)).warning(
            f"use_sim_time is true, and {why}: the clock of this node stands at 0, and its timers "
            "wait. Start the simulator, or `aionode bag play --clock`, or set use_sim_time to "
            "false"
        )

    def stop(self) -> None:
        """Stop waiting."""
        if self._alarm is not None:
            self._alarm.cancel()


def why_no_time(clock: Any) -> str:
    """Return why the `clock` of a ``/clock`` message is not a valid time; empty if it is.

    Any node can publish there, so an invalid message must not end a node: it is ignored, and logged
    once.
    """
    if clock.sec >= 0 and clock.nanosec < S_TO_NS:
        return ""
    return (
        f"/clock: ignored an invalid time: {clock.sec} s and {clock.nanosec} ns; seconds must be "
        f"at least 0, and nanoseconds less than {S_TO_NS}; `aionode topic info -v /clock` names "
        "the publishers"
    )
