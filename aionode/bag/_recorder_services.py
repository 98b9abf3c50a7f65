"""rosbag2's services and topics of a recorder's node."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final, Protocol

from aionode.errors import AionodeError, InterfaceNotFoundError
from aionode.interfaces import get_interface
from aionode.interfaces.rosbag2_interfaces import msg as bag_msg
from aionode.interfaces.rosbag2_interfaces import srv as bag_srv

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from aionode.node import Node

__all__ = ["RecorderServices"]

REPORT_S: Final = 1.0
"""How often losses are told at most, in seconds."""


class Recording(Protocol):
    """What of a `Recorder` is told and controlled."""

    node: Node

    @property
    def stats(self) -> Mapping[str, tuple[int, int, int]]:
        """What was recorded, lost in transport and lost in the recorder, by topic."""

    @property
    def paused(self) -> bool:
        """Whether it is paused."""

    @property
    def discovering(self) -> bool:
        """Whether topics that appear are recorded."""

    def pause(self) -> None:
        """Record nothing until `resume`."""

    def resume(self) -> None:
        """Record again."""

    def start_discovery(self) -> None:
        """Record topics that appear."""

    def stop_discovery(self) -> None:
        """Record no further topics."""

    async def split(self) -> None:
        """Begin a new file."""

    async def snapshot(self) -> None:
        """Write what is kept."""


class RecorderServices:
    """Serves ``~/pause`` and the others, and tells of splits and of losses.

    Args:
        recorder: The recorder, whose node runs.
    """

    def __init__(self, recorder: Recording) -> None:
        self._recorder = recorder
        self._node = node = recorder.node
        self._splits = node.create_publisher(bag_msg.WriteSplitEvent, "events/write_split", 10)
        self._reported: dict[str, tuple[int, int]] = {}
        handlers: dict[str, tuple[Any, Callable[[Any, Any], Any]]] = {
            "pause": (bag_srv.Pause, doing(recorder.pause)),
            "resume": (bag_srv.Resume, doing(recorder.resume)),
            "is_paused": (bag_srv.IsPaused, self._tell_paused),
            "split_bagfile": (bag_srv.SplitBagfile, self._split),
            "snapshot": (bag_srv.Snapshot, self._snapshot),
            "start_discovery": (bag_srv.StartDiscovery, doing(recorder.start_discovery)),
            "stop_discovery": (bag_srv.StopDiscovery, doing(recorder.stop_discovery)),
            "is_discovery_running": (bag_srv.IsDiscoveryRunning, self._tell_discovery),
        }
        for name, (srv_type, handler) in handlers.items():
            node.create_service(srv_type, f"~/{name}", handler)
        try:
            self._loss_type = get_interface("rosbag2_interfaces/msg/MessagesLostEvent")
            self._topic_type = get_interface("rosbag2_interfaces/msg/MessagesLostEventTopicStat")
        except InterfaceNotFoundError:
            return
        self._losses = node.create_publisher(self._loss_type, "events/rosbag2_messages_lost", 10)
        node.create_timer(REPORT_S, self._tell_losses)

    def tell_split(self, closed: str, opened: str) -> None:
        """Publish that the recorder went on to its next file."""
        self._splits.publish(
            bag_msg.WriteSplitEvent(
                closed_file=closed,
                opened_file=opened,
                node_name=self._node.get_fully_qualified_name(),
            )
        )

    def _tell_losses(self) -> None:
        """Publish what was lost since the last time, if anything."""
        now = {
            name: (transport, recorder)
            for name, (_, transport, recorder) in self._recorder.stats.items()
        }
        before, self._reported = self._reported, now
        lost = [
            self._topic_type(
                topic_name=name,
                messages_lost_in_transport=transport - before.get(name, (0, 0))[0],
                messages_lost_in_recorder=recorder - before.get(name, (0, 0))[1],
            )
            for name, (transport, recorder) in now.items()
            if (transport, recorder) != before.get(name, (0, 0))
        ]
        if lost:
            self._losses.publish(
                self._loss_type(
                    node_name=self._node.get_fully_qualified_name(),
                    messages_lost_statistics=lost,
                )
            )

    def _tell_paused(self, _: Any, response: Any) -> Any:
        response.paused = self._recorder.paused
        return response

    def _tell_discovery(self, _: Any, response: Any) -> Any:
        response.running = self._recorder.discovering
        return response

    async def _split(self, _: Any, response: Any) -> Any:
        await self._recorder.split()
        return response

    async def _snapshot(self, _: Any, response: Any) -> Any:
        try:
            await self._recorder.snapshot()
        except AionodeError as error:
            self._node.get_logger().warning(str(error))
            response.success = False
        else:
            response.success = True
        return response


def doing(act: Callable[[], None]) -> Callable[[Any, Any], Any]:
    """Return the handler of a service that only does something."""

    def handler(_: Any, response: Any) -> Any:
        act()
        return response

    return handler
