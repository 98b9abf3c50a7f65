"""A bag's player, controlled by Foxglove's timeline, and the time sent to clients."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Final, TypeAlias

from aionode.clock import S_TO_NS, Time
from aionode.errors import MessageError, RefusedError
from aionode.gateway.foxglove import frames

if TYPE_CHECKING:
    from aionode.bag import Player
    from aionode.gateway.session.feed import Received
    from aionode.gateway.session.session import Session

__all__ = ["Playback"]

Begin: TypeAlias = Callable[..., None]

PERIOD_SEC: Final = 0.05
"""Time between two time messages while a player plays."""


class Playback:
    """The player, as one client sees and controls it.

    It controls the player through the services of the player's node, so that the policy applies to
    each of them.

    Args:
        session: The session of the client.
        player: The player, or None.
    """

    def __init__(self, session: Session, player: Player | None) -> None:
        self._session = session
        self._player = player
        self._told: tuple[int, float] | None = None
        self._clock = session.robot.node.get_clock()

    @property
    def capabilities(self) -> list[str]:
        """The server capabilities that a player adds."""
        return [] if self._player is None else ["playbackControl"]

    @property
    def range(self) -> dict[str, Any]:
        """The start and end of the recording."""
        if self._player is None:
            return {}
        return {
            "dataStartTime": seconds(self._player.start.nanoseconds),
            "dataEndTime": seconds(self._player.end.nanoseconds),
        }

    def time_ns(self, received: Received) -> int:
        """Return the time of a message on the client's timeline."""
        if self._player is not None:
            return self._player.time.nanoseconds
        return self._clock.now().nanoseconds if self._clock.ros_time_is_active else received.time_ns

    async def watch(self) -> None:
        """Send the client the time, and the state of the player."""
        if self._player is None:
            await self._watch_clock()
            return
        while True:
            state = (status_of(self._player), self._player.rate)
            if state != self._told:
                self._tell(self._player)
            if state[0] == frames.PLAYING:
                frame = frames.time_frame(self._player.time.nanoseconds)
                self._session.outbox.put("time", frame, 1)
            await self._session.robot.clock.sleep(PERIOD_SEC)

    async def _watch_clock(self) -> None:
        """Send the client simulated time, if the gateway's node uses it."""
        if self._clock.ros_time_is_active:
            try:
                await self._session.subscribe(
                    "/clock", "rosgraph_msgs/msg/Clock", frame=clock_frame, key="time", depth=1
                )
            except RefusedError as error:
                self._session.rights.note_failure(error, "simulated time")

    async def control(self, begin: Begin, request: frames.PlaybackRequest) -> None:
        """Control the player as requested, and send the client the resulting state.

        Args:
            begin: Starts work that ends with the client.
            request: The client's wish.

        Raises:
            MessageError: there is no player, or it has no such time.
            RefusedError: the policy refuses it.
        """
        player = self._player
        if player is None:
            raise MessageError("playback", "this gateway has no player")
        if request.rate != player.rate:
            await self._call(player, "set_rate", {"rate": request.rate})
        if request.seek_ns is not None:
            sec, nanosec = divmod(request.seek_ns, S_TO_NS)
            await self._call(player, "seek", {"time": {"sec": sec, "nanosec": nanosec}})
        if request.paused != player.paused:
            await self._call(player, "pause" if request.paused else "resume", {})
        if not request.paused and not player.playing:
            start_ns = player.start.nanoseconds
            offset_ns = (request.seek_ns or start_ns) - start_ns
            sec, nanosec = divmod(offset_ns, S_TO_NS)
            again = {"start_offset": {"sec": sec, "nanosec": nanosec}}
            begin(self._call, player, "play", again)  # which ends with the recording
        self._tell(player, request)

    async def _call(self, player: Player, name: str, values: dict[str, Any]) -> None:
        service = f"{player.node.get_fully_qualified_name()}/{name}"
        response = await self._session.call(service, values, timeout_sec=None)
        if not getattr(response, "success", True):
            raise MessageError(service, f"{values} was refused by the player")

    def _tell(self, player: Player, request: frames.PlaybackRequest | None = None) -> None:
        status = status_of(player)
        self._told = (status, player.rate)
        frame = frames.playback_frame(
            status,
            player.time.nanoseconds,
            player.rate,
            did_seek=request is not None and request.seek_ns is not None,
            request_id="" if request is None else request.request_id,
        )
        self._session.outbox.send(frame)


def status_of(player: Player) -> int:
    """Return the state of a player, in the numbers of the protocol."""
    if player.paused:
        return frames.PAUSED
    return frames.PLAYING if player.playing else frames.ENDED


def clock_frame(received: Received) -> bytes:
    """Return the frame of a message of /clock."""
    return frames.time_frame(Time.from_msg(received.message.clock).nanoseconds)


def seconds(time_ns: int) -> dict[str, int]:
    """Return a time in the protocol's JSON form."""
    sec, nsec = divmod(time_ns, S_TO_NS)
    return {"sec": sec, "nsec": nsec}
