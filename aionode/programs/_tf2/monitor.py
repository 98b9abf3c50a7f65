"""``tf2_ros tf2_monitor``: prints the delays of transforms every ten seconds."""

from __future__ import annotations

import sys
from collections import deque
from collections.abc import Callable, Iterable
from typing import Any, Final

import aionode
from aionode import DurabilityPolicy, Node, QoSProfile, Time
from aionode.arguments import remove_ros_args
from aionode.interfaces.tf2_msgs.msg import TFMessage
from aionode.programs._tf2.echo import WAITING_SEC, show
from aionode.programs._wall_timer import create_wall_timer
from aionode.tf import Buffer, TransformException

__all__ = ["Monitor", "main"]

TICK_SEC: Final = 0.5
TICKS: Final = 21
"""The number of checks after which the results are printed."""

KEPT: Final = 1000
"""Number of delays that are remembered, for each frame and in total."""

MAX_FRAMES: Final = 10_000
LOWPASS: Final = 0.01

AUTHORITY: Final = "<no authority available>"


def mean_and_most(numbers: Iterable[float]) -> tuple[float, float]:
    """Return the mean of numbers, and the greatest above 0."""
    given = list(numbers)
    return sum(given) / len(given), max(0.0, *given)


class Monitor(Node):
    """Shows the delays of all frames, or of those between two.

    Args:
        frames: The frame to express things in and the frame that they are in, or none.
        show: Called with each text.
    """

    def __init__(self, frames: tuple[str, str] | None, show: Callable[[str], object]) -> None:
        super().__init__("tf2_monitor_main")
        self.frames = frames
        self.show = show
        self.buffer = Buffer(self)
        self.chain: list[str] = []
        self.delays: dict[str, deque[float]] = {}
        self.arrivals: deque[tuple[float, float]] = deque(maxlen=KEPT)
        self.ticks = 0
        self.mean = self.most = 0.0
        latched = QoSProfile(depth=100, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        self.create_subscription(TFMessage, "/tf", self.on_transforms, 100)
        self.create_subscription(TFMessage, "/tf_static", self.on_transforms, latched)
        create_wall_timer(self, TICK_SEC, self.tick)
        self.has_begun = False

    def now(self) -> float:
        """Return the time, in seconds."""
        return self.get_clock().now().nanoseconds / 1e9

    def on_transforms(self, msg: TFMessage) -> None:
        """Record the delays of transforms."""
        now = self.now()
        delays = []
        for each in msg.transforms:
            delay = now - (each.header.stamp.sec + each.header.stamp.nanosec / 1e9)
            delays.append(delay)
            if each.child_frame_id in self.delays or len(self.delays) < MAX_FRAMES:
                kept = self.delays.setdefault(each.child_frame_id, deque(maxlen=KEPT))
                kept.append(delay)
        self.arrivals.append((now, sum(delays) / max(1, len(delays))))

    def is_ready(self) -> bool:
        """Return whether there is a transform between the frames; if not, log that."""
        if self.has_begun:
            return True
        if self.frames is not None:
            into, out_of = self.frames
            can, why = self.buffer.can_transform_core(into, out_of, Time())
            if not can:
                self.get_logger().info(
                    f"Waiting for transform {into} ->  {out_of}: {why}",
                    throttle_duration_sec=WAITING_SEC,
                )
                return False
            latest: Any = Time()
            self.chain = self.buffer._chain(out_of, latest, into, latest, out_of)
        what = "all frames" if self.frames is None else " -> ".join(self.frames)
        self.show(f"Gathering data on {what} for 10 seconds...\n")
        self.has_begun = True
        return True

    def tick(self) -> None:
        """Check, and show the results every ten seconds."""
        if not self.is_ready():
            return
        if self.frames is not None:
            try:
                stamp = self.buffer.lookup_transform(*self.frames).header.stamp
            except TransformException as error:
                self.get_logger().warning(f"Transform Exception {error}")
                return
            delay = self.now() - (stamp.sec + stamp.nanosec / 1e9)
            self.mean = LOWPASS * delay + (1 - LOWPASS) * self.mean
            self.most = max(self.most, delay)
        self.ticks += 1
        if self.ticks >= TICKS:
            self.ticks = 0
            self.show(self.results())

    def results(self) -> str:
        """Return the results as printed."""
        lines = ["", "", "", "RESULTS: for all Frames"]
        if self.frames is not None:
            lines[3:] = [
                f"RESULTS: for {self.frames[0]} to {self.frames[1]}",
                f"Chain is: {' -> '.join(self.chain)}",
                f"Net delay     avg = {self.mean:g}: max = {self.most:g}",
            ]
        lines += ["", "Frames:"]
        for frame, kept in sorted(self.delays.items()):
            if self.frames is None or frame in self.chain:
                mean, most = mean_and_most(kept)
                lines.append(
                    f"Frame: {frame}, published by {AUTHORITY}, Average Delay: {mean:g}, "
                    f"Max Delay: {most:g}"
                )
        lines += ["", "All Broadcasters:"]
        if self.arrivals:
            mean, most = mean_and_most(delay for _, delay in self.arrivals)
            passed = max(1e-8, self.arrivals[-1][0] - self.arrivals[0][0])
            lines.append(
                f"Node: {AUTHORITY} {len(self.arrivals) / passed:g} Hz, Average Delay: {mean:g} "
                f"Max Delay: {most:g}"
            )
        return "\n".join(lines) + "\n"


def main() -> None:
    """Print the delays of transforms until Ctrl-C.

    Raises:
        SystemExit: With status 255: the arguments are neither none nor two frames.
    """
    words = remove_ros_args(sys.argv)[1:]
    if len(words) not in (0, 2):
        sys.stderr.write("TF_Monitor: usage: tf2_monitor framea frameb\n")
        raise SystemExit(255)
    frames = (words[0], words[1]) if words else None
    aionode.run(lambda: Monitor(frames, show))
