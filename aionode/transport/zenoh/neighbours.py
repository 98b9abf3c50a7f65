"""Who is connected, and which contexts of aionode say more of themselves than ROS asks for."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

import zenoh

from aionode.transport.zenoh.handlers import direct, translated

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable

    from aionode.transport.zenoh.link import Link

__all__ = ["Neighbours"]

PREFIX: Final = "@aionode"


class Neighbours:
    """Tokens beside the ROS graph, and the sessions that are connected.

    Attributes:
        beacon: What to announce, as chunks of a key that begin with the participant; None for
            nothing, and then nothing is looked for either.
        on_beacon: Called with what another context announces, and whether it is there.
        on_sessions: Called with the ids of the sessions that are connected, when that has changed.
    """

    def __init__(self, link: Link) -> None:
        self.beacon: str | None = None
        self.on_beacon: Callable[[str, bool], None] = ignore
        self.on_sessions: Callable[[Iterable[str]], None] = ignore
        self._prefix = f"{PREFIX}/{link.domain_id}/"
        self._beacons = link.lane(self._take_beacon)
        self._sessions = link.lane(self._take_sessions, 1)
        self._declared: list[Any] = []
        self._session: zenoh.Session | None = None

    def start(self, session: zenoh.Session) -> None:
        """Announce and listen; what exists already comes at once."""
        if self.beacon is None:
            return
        self._session = session
        with translated("links"):
            self._declared = [
                session.liveliness().declare_subscriber(
                    f"{self._prefix}*/link/**", direct(self._beacons.put), history=True
                ),
                session.info.declare_transport_events_listener(direct(self._sessions.put)),
                session.liveliness().declare_token(self._prefix + self.beacon),
            ]
        self.on_sessions(connected(session))

    def stop(self) -> None:
        """Announce nothing, and listen no longer."""
        self._session = None
        declared, self._declared = self._declared, []
        for one in reversed(declared):
            one.undeclare()
        self._beacons.clear()
        self._sessions.clear()

    def _take_beacon(self, sample: zenoh.Sample) -> None:
        text = str(sample.key_expr).removeprefix(self._prefix)
        self.on_beacon(text, sample.kind == zenoh.SampleKind.PUT)

    def _take_sessions(self, _: object) -> None:
        if self._session is not None:
            self.on_sessions(connected(self._session))


def connected(session: zenoh.Session) -> set[str]:
    """Return the ids of the sessions that are connected to this one."""
    return {str(transport.zid) for transport in session.info.transports()}


def ignore(*_: object) -> None:
    """Do nothing."""
