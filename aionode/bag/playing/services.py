"""rosbag2's services of a player node."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any, Protocol

from aionode.bag.recording.services import answered, offered
from aionode.clock import Duration, Time
from aionode.interfaces.rosbag2_interfaces import srv as bag_srv

if TYPE_CHECKING:
    from collections.abc import Callable

    from aionode.node import Node

__all__ = ["serve_player"]


class Playing(Protocol):
    """The parts of a `Player` that its services show and control."""

    @property
    def playing(self) -> bool:
        """Whether it is playing, possibly paused."""

    @property
    def paused(self) -> bool:
        """Whether it is paused."""

    @property
    def rate(self) -> float:
        """The current rate."""

    def pause(self) -> None:
        """Stop the recorded time."""

    def resume(self) -> None:
        """Resume."""

    def toggle_paused(self) -> None:
        """Pause or resume."""

    def stop(self) -> None:
        """End `play`."""

    def set_rate(self, rate: float) -> None:
        """Change the rate."""

    def seek(self, time: Time) -> bool:
        """Continue at another time."""

    async def burst(self, count: int = 0) -> int:
        """Publish the next messages immediately."""

    async def play(
        self,
        start_offset: Duration | None = None,
        duration: Duration | None = None,
        until: Time | None = None,
    ) -> bool:
        """Play."""


def serve_player(node: Node, player: Playing) -> None:  # noqa: C901  # a handler for each service
    """Offer ``~/pause`` and the other services on a player's node."""

    def doing(act: Callable[[], None]) -> Callable[[Any, Any], Any]:
        def handler(_: Any, response: Any) -> Any:
            act()
            return response

        return handler

    def resume(request: Any, response: Any) -> Any:
        stamp = getattr(request, "resume_time", None)
        if stamp is not None and Time.from_msg(stamp).nanoseconds:
            return answered(response, 3, "players do not support resume_time: leave it 0")
        player.resume()
        return answered(response, 0)

    def stop(_: Any, response: Any) -> Any:
        if not player.playing:
            return answered(response, 1, "the player is already stopped")
        player.stop()
        return answered(response, 0)

    def is_paused(_: Any, response: Any) -> Any:
        response.paused = player.paused
        return response

    def get_rate(_: Any, response: Any) -> Any:
        response.rate = player.rate
        return response

    def set_rate(request: Any, response: Any) -> Any:
        try:
            player.set_rate(request.rate)
        except ValueError:
            response.success = False
        else:
            response.success = True
        return response

    def seek(request: Any, response: Any) -> Any:
        response.success = player.seek(Time.from_msg(request.time))
        return response

    async def play_next(_: Any, response: Any) -> Any:
        response.success = await player.burst(1) == 1
        return response

    async def burst(request: Any, response: Any) -> Any:
        response.actually_burst = await player.burst(request.num_messages)
        return response

    async def play(request: Any, response: Any) -> Any:
        length = Duration.from_msg(request.playback_duration)
        until = request.playback_until_timestamp
        response.success = await player.play(
            Duration(nanoseconds=Time.from_msg(request.start_offset).nanoseconds),  # not a Duration
            length if length.nanoseconds > 0 else None,
            Time.from_msg(until) if until.sec >= 0 and (until.sec or until.nanosec) else None,
        )
        return response

    handlers: dict[str, tuple[Any, Callable[[Any, Any], Any]]] = {
        "pause": (bag_srv.Pause, doing(player.pause)),
        "resume": (bag_srv.Resume, resume),
        "toggle_paused": (bag_srv.TogglePaused, doing(player.toggle_paused)),
        "stop": (bag_srv.Stop, stop),
        "is_paused": (bag_srv.IsPaused, is_paused),
        "get_rate": (bag_srv.GetRate, get_rate),
        "set_rate": (bag_srv.SetRate, set_rate),
        "seek": (bag_srv.Seek, seek),
        "play_next": (bag_srv.PlayNext, play_next),
        "burst": (bag_srv.Burst, burst),
        "play": (bag_srv.Play, play),
    }
    offered(
        node,
        [
            partial(node.create_service, srv_type, f"~/{name}", handler, concurrent=True)
            for name, (srv_type, handler) in handlers.items()
        ],
    )
