"""rosbag2's services and topics of a recorder node."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Any, Final, Protocol

from aionode.clock import Time
from aionode.errors import AionodeError, TransportError
from aionode.interfaces.rosbag2_interfaces import msg as bag_msg
from aionode.interfaces.rosbag2_interfaces import srv as bag_srv

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from aionode.node import Node

__all__ = ["RecorderServices", "answered", "offered"]

NOT_RECORDING: Final = 1
"""The return code of ``~/split_bagfile`` while no bag is open; other services use it too."""

INVALID_TOPIC: Final = {"resume": 2, "split": 3}
FAILED: Final = {"resume": 3, "split": 4}


class Recording(Protocol):
    """The parts of a `Recorder` that its services show and control."""

    node: Node

    @property
    def stats(self) -> Mapping[str, tuple[int, int, int]]:
        """The messages recorded, lost in transport and lost in the recorder, by topic."""

    @property
    def recording(self) -> bool:
        """Whether a bag is open."""

    @property
    def paused(self) -> bool:
        """Whether it is paused."""

    @property
    def discovering(self) -> bool:
        """Whether topics that appear are recorded."""

    def pause(self) -> None:
        """Record nothing until `resume`."""

    def resume(self, at: Time | None = None, *, mode: int = 0, topic: str = "") -> None:
        """Resume recording."""

    def start_discovery(self) -> None:
        """Record topics that appear."""

    def stop_discovery(self) -> None:
        """Stop recording further topics."""

    async def split(self, at: Time | None = None, *, mode: int = 0, topic: str = "") -> None:
        """Start a new file."""

    async def stop(self) -> None:
        """Close the bag."""

    async def record(self, path: str = "") -> None:
        """Start another bag."""

    async def snapshot(self) -> None:
        """Write the messages that are kept."""


class RecorderServices:
    """Serves ``~/pause`` and the other services, and publishes splits and losses.

    Args:
        recorder: The recorder, whose node is running.
        report_hz: Maximum rate at which losses are published, in Hz; 0 for never.
    """

    def __init__(self, recorder: Recording, report_hz: float) -> None:
        self._recorder = recorder
        self._node = node = recorder.node
        self._reported: dict[str, tuple[int, int]] = {}
        handlers: dict[str, tuple[Any, Callable[[Any, Any], Any]]] = {
            "pause": (bag_srv.Pause, doing(recorder.pause)),
            "resume": (bag_srv.Resume, self._resume),
            "record": (bag_srv.Record, self._record),
            "stop": (bag_srv.Stop, self._stop),
            "is_paused": (bag_srv.IsPaused, self._tell_paused),
            "split_bagfile": (bag_srv.SplitBagfile, self._split),
            "snapshot": (bag_srv.Snapshot, self._snapshot),
            "start_discovery": (bag_srv.StartDiscovery, doing(recorder.start_discovery)),
            "stop_discovery": (bag_srv.StopDiscovery, doing(recorder.stop_discovery)),
            "is_discovery_running": (bag_srv.IsDiscoveryRunning, self._tell_discovery),
        }
        losses, splits = "events/rosbag2_messages_lost", "events/write_split"
        make = node.create_publisher
        self._splits, self._losses, *_ = offered(
            node,
            [
                partial(make, bag_msg.WriteSplitEvent, splits, 10),
                partial(make, bag_msg.MessagesLostEvent, losses, 10),
                *(
                    partial(node.create_service, srv_type, f"~/{name}", handler)
                    for name, (srv_type, handler) in handlers.items()
                ),
            ],
        )
        if report_hz and self._losses is not None:
            node.create_timer(1 / report_hz, self._tell_losses)

    def tell_split(self, closed: str, opened: str) -> None:
        """Publish that the recorder has moved on to its next file."""
        if self._splits is None or self._splits.destroyed:  # the last rows outlive the node
            return
        self._splits.publish(
            bag_msg.WriteSplitEvent(
                closed_file=closed,
                opened_file=opened,
                node_name=self._node.get_fully_qualified_name(),
            )
        )

    def _tell_losses(self) -> None:
        """Publish what was lost since the last report, if anything."""
        now = {
            name: (transport, recorder)
            for name, (_, transport, recorder) in self._recorder.stats.items()
        }
        before, self._reported = self._reported, now
        lost = [
            bag_msg.MessagesLostEventTopicStat(
                topic_name=name,
                messages_lost_in_transport=max(transport - before.get(name, (0, 0))[0], 0),
                messages_lost_in_recorder=max(recorder - before.get(name, (0, 0))[1], 0),
            )
            for name, (transport, recorder) in now.items()
            if (transport, recorder) != before.get(name, (0, 0))
        ]
        if lost and self._losses is not None:
            self._losses.publish(
                bag_msg.MessagesLostEvent(
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

    def _resume(self, request: Any, response: Any) -> Any:
        at, mode, topic = when(request, "resume")
        if mode not in {0, 1, 2}:
            return answered(response, 1, f"resume_mode {mode} is unknown; use 0, 1 or 2")
        try:
            self._recorder.resume(at, mode=mode, topic=topic)
        except AionodeError as error:
            return answered(response, (INVALID_TOPIC if topic else FAILED)["resume"], str(error))
        return answered(response, 0)

    async def _split(self, request: Any, response: Any) -> Any:
        at, mode, topic = when(request, "split")
        if not self._recorder.recording:
            return answered(response, NOT_RECORDING, "the recorder is stopped")
        if mode not in {0, 1, 2}:
            return answered(response, 2, f"split_mode {mode} is unknown; use 0, 1 or 2")
        try:
            await self._recorder.split(at, mode=mode, topic=topic)
        except OSError as error:
            return answered(response, FAILED["split"], str(error))
        except AionodeError as error:
            return answered(response, INVALID_TOPIC["split"], str(error))
        return answered(response, 0)

    async def _record(self, request: Any, response: Any) -> Any:
        try:
            await self._recorder.record(request.uri)
        except AionodeError as error:
            return answered(response, 1, str(error))
        return answered(response, 0)

    async def _stop(self, _: Any, response: Any) -> Any:
        if not self._recorder.recording:
            return answered(response, 1, "the recorder is already stopped")
        try:
            await self._recorder.stop()
        except AionodeError as error:
            return answered(response, 1, str(error))
        return answered(response, 0)

    async def _snapshot(self, _: Any, response: Any) -> Any:
        try:
            await self._recorder.snapshot()
        except AionodeError as error:
            self._node.get_logger().warning(str(error))
            response.success = False
        else:
            response.success = True
        return response


def offered(node: Node, makes: Sequence[Callable[[], Any]]) -> list[Any]:
    """Return what the given calls create; None for types that the ROS in use does not have.

    This lets a recorder or player run over an installed ROS 2 without rosbag2.
    """
    made: list[Any] = []
    missing: TransportError | None = None
    for make in makes:
        try:
            made.append(make())
        except TransportError as error:
            missing = missing or error
            made.append(None)
    if missing is not None:
        node.get_logger().warning(f"some services and topics of rosbag2 are unavailable: {missing}")
    return made


def when(request: Any, what: str) -> tuple[Time | None, int, str]:
    """Return the time at which a request takes effect; before Lyrical, it has no such fields."""
    stamp = getattr(request, f"{what}_time", None)
    if stamp is None:
        return None, 0, ""
    at = Time.from_msg(stamp)
    mode = getattr(request, f"{what}_mode")
    return at if at.nanoseconds > 0 else None, mode, request.tracking_topic_name


def answered(response: Any, code: int, text: str = "") -> Any:
    """Set the code and text of a response, if its type has them: before Lyrical, few do."""
    if hasattr(response, "return_code"):
        response.return_code, response.error_string = code, text
    return response


def doing(act: Callable[[], None]) -> Callable[[Any, Any], Any]:
    """Return the handler of a service that only calls a function."""

    def handler(_: Any, response: Any) -> Any:
        act()
        return response

    return handler
