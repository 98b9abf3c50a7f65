"""The tree of frames with its history: tf2's BufferCore, without I/O."""

from __future__ import annotations

from math import isnan
from typing import TYPE_CHECKING, Any

from aionode.clock import S_TO_NS, Duration, Time
from aionode.errors import (
    InvalidArgumentException,
    LookupException,
    TransformException,
    escaped,
    shortened,
)
from aionode.interfaces.builtin_interfaces.msg import Time as TimeMsg
from aionode.interfaces.geometry_msgs.msg import Quaternion, Transform, TransformStamped, Vector3
from aionode.interfaces.std_msgs.msg import Header
from aionode.logging import get_logger
from aionode.tf import frame_listing
from aionode.tf._arithmetic import Pose, composed, unit
from aionode.tf._chain import chain
from aionode.tf._frames import DynamicFrame, Frame, Room, StaticFrame, Tree
from aionode.tf._refusals import (
    TOLERANCE,
    mistakes,
    old_data,
    too_long,
    too_many,
    two_broadcasters,
)
from aionode.tf._routes import Routes
from aionode.tf._velocity import velocity
from aionode.tf._walk import Failure, Walk, latest_common_ns, walk

if TYPE_CHECKING:
    from collections.abc import Mapping

    from aionode.tf._velocity import Vector, Velocity

__all__ = [
    "CACHE_TIME_SEC",
    "MAX_FRAMES",
    "MAX_NAME",
    "BufferCore",
    "authorities_of",
    "duration_ns",
    "frames_of",
    "rivals_of",
    "time_ns_of",
]

CACHE_TIME_SEC = 10.0
"""How long transforms are kept by default, in seconds."""

MAX_FRAMES = 10_000
"""Maximum frames of a buffer; tf2 has no limit."""

MAX_NAME = 1_000
"""Maximum length of a frame name."""

MAX_REPORTS = 1_000
"""Maximum refusals that are logged, each kind and sender once."""

ROUNDING = 1e-12
"""Below this excess a quaternion is not normalized, which would only add rounding."""


def time_ns_of(time: Any) -> int:
    """Convert a time to nanoseconds: anything with `sec` and `nanosec`, or `nanoseconds`.

    Raises:
        TypeError: it has neither.
    """
    if isinstance(time, Time):
        return time.nanoseconds
    if isinstance(time, TimeMsg):
        return time.sec * S_TO_NS + time.nanosec
    if hasattr(time, "nanoseconds"):
        return int(time.nanoseconds)
    if hasattr(time, "sec") and hasattr(time, "nanosec"):
        return int(time.sec) * S_TO_NS + int(time.nanosec)
    raise TypeError("time must have sec and nanosec, or nanoseconds.")


def duration_ns(duration: Any) -> int:
    """Convert a duration to nanoseconds: seconds, or anything that `time_ns_of` accepts.

    Raises:
        TypeError: it is none of these.
    """
    if isinstance(duration, int | float):
        return round(duration * S_TO_NS)
    try:
        return time_ns_of(duration)
    except TypeError:
        raise TypeError("duration must have sec and nanosec, or nanoseconds.") from None


class BufferCore:
    """Keeps the transforms between frames for some time, and answers for any two of them.

    The methods have the names of tf2's Python class, and their rules and texts are tf2's. Times are
    `Time`, messages of builtin_interfaces, or anything with `nanoseconds`; 0 means the latest
    common time.

    Memory is bounded: `MAX_FRAMES` frames, and `MAX_SAMPLES` poses of all frames together.

    Args:
        cache_time: How long transforms are kept: a Duration, or seconds.

    Raises:
        TypeError: `cache_time` is neither.
        ValueError: it is negative.
    """

    def __init__(self, cache_time: Duration | float = CACHE_TIME_SEC) -> None:
        cache_ns = duration_ns(cache_time)
        if cache_ns < 0:
            raise ValueError(f"cache_time is {cache_ns / S_TO_NS:g} s; it must not be negative")
        self._BufferCore__cache_ns = cache_ns
        self._BufferCore__room = Room()
        self._BufferCore__frames = Tree()
        self._BufferCore__routes = Routes(self._BufferCore__frames)
        self._BufferCore__authorities: dict[str, str] = {}
        self._BufferCore__rivals: dict[str, str] = {}  # for each frame, its previous sender
        self._BufferCore__reported: set[tuple[str, str]] = (
            set()
        )  # kinds of refusals and their senders
        self._BufferCore__logger = get_logger("tf2_buffer")

    # Setting

    def set_transform(self, transform: Any, authority: str) -> None:
        """Add a changing transform; it replaces a static one of the same frame.

        What tf2 rejects is rejected, and logged once per sender: a frame that is its own parent,
        empty names, NaN, a quaternion whose length is not 1, data older than the cache time.

        Args:
            transform: A TransformStamped.
            authority: Its sender.
        """
        self._BufferCore__set(transform, authority, is_static=False)

    def set_transform_static(self, transform: Any, authority: str) -> None:
        """Add a static transform; it replaces the history of the frame.

        Args:
            transform: A TransformStamped.
            authority: Its sender.
        """
        self._BufferCore__set(transform, authority, is_static=True)

    def _BufferCore__set(self, msg: Any, authority: str, *, is_static: bool) -> bool:  # the checks
        """Add a transform; return whether it was accepted."""
        header = msg.header
        child, parent = msg.child_frame_id, header.frame_id
        if child[:1] == "/" or parent[:1] == "/":  # names of tf, which tf2 does not have
            child, parent = child.removeprefix("/"), parent.removeprefix("/")
        translation, rotation = msg.transform.translation, msg.transform.rotation
        x, y, z = translation.x, translation.y, translation.z
        i, j, k, w = rotation.x, rotation.y, rotation.z, rotation.w
        pose: Pose = (x, y, z, i, j, k, w)
        excess = abs(i * i + j * j + k * k + w * w - 1.0)
        if (
            child == parent
            or not child
            or not parent
            or not excess < TOLERANCE  # also for NaN
            or isnan(x + y + z)  # also true for infinite coordinates, which are valid
        ):
            refusals = mistakes(child, parent, pose, authority)
            if refusals:
                self._BufferCore__refuse(refusals, authority)
                return False
        if excess > ROUNDING:
            pose = unit(pose)
        frame = self._BufferCore__frames.get(child)
        if (
            frame is None
            or frame.is_static is not is_static
            or parent not in self._BufferCore__frames.names
        ):
            frame = self._BufferCore__admitted(child, parent, pose, authority, is_static=is_static)
            if frame is None:
                return False
        before = frame.latest()
        stamp_ns = time_ns_of(header.stamp)
        if not frame.insert(stamp_ns, parent, pose):
            text = old_data(child, frame_listing.seconds_text(stamp_ns), authority)
            self._BufferCore__report("TF_OLD_DATA", authority, text)
            return False
        if before is None or before[1] != parent:
            self._BufferCore__routes.forget()
        if self._BufferCore__authorities.get(child) != authority:
            self._BufferCore__note_authority(child, authority)
        self._BufferCore__changed(child, frame, before)
        return True

    def _BufferCore__changed(
        self, child: str, frame: Frame, before: tuple[int, str] | None
    ) -> None:
        """Handle a frame's new transform; a hook for subclasses.

        Args:
            child: The name of the frame.
            frame: Its data.
            before: Its newest stamp and parent before that.
        """

    def _BufferCore__admitted(
        self, child: str, parent: str, pose: Pose, authority: str, *, is_static: bool
    ) -> Frame | None:
        """Return the frame object of the given kind; None if there is no room for its name."""
        new = [name for name in (child, parent) if name not in self._BufferCore__frames.names]
        if any(len(name) > MAX_NAME for name in new):
            self._BufferCore__report("TF_LONG_FRAME_ID", authority, too_long(MAX_NAME, authority))
            return None
        if len(self._BufferCore__frames.names) + len(new) > MAX_FRAMES:
            self._BufferCore__report(
                "TF_TOO_MANY_FRAMES", authority, too_many(MAX_FRAMES, authority)
            )
            return None
        self._BufferCore__frames.names.update(dict.fromkeys(new))
        frame = self._BufferCore__frames.get(child)
        if frame is None or frame.is_static is not is_static:
            if frame is not None:
                frame.clear()  # releases its room
            frame = (
                StaticFrame(parent, pose)
                if is_static
                else DynamicFrame(self._BufferCore__cache_ns, self._BufferCore__room)
            )
            self._BufferCore__frames[child] = frame
            self._BufferCore__routes.forget()
        return frame

    def _BufferCore__note_authority(self, child: str, authority: str) -> None:
        """Record the sender of a frame, and report two alternating senders."""
        last = self._BufferCore__authorities.get(child)
        self._BufferCore__authorities[child] = authority
        if last is None:
            return
        if self._BufferCore__rivals.get(child) == authority:
            text = two_broadcasters(child, last, authority)
            self._BufferCore__report("TF_TWO_BROADCASTERS", child, text)
        self._BufferCore__rivals[child] = last

    def _BufferCore__rename_authority(self, before: str, name: str) -> None:
        """Rename an authority everywhere."""
        for record in (self._BufferCore__authorities, self._BufferCore__rivals):
            record.update(dict.fromkeys([c for c, by in record.items() if by == before], name))
        for child in [
            c
            for c, by in self._BufferCore__rivals.items()
            if by == self._BufferCore__authorities[c]
        ]:
            del self._BufferCore__rivals[child]  # they were two publishers of one node

    def _BufferCore__refuse(self, refusals: list[tuple[str, str]], authority: str) -> None:
        """Log what is wrong with a transform."""
        for kind, text in refusals:
            self._BufferCore__report(kind, authority, text, is_error=True)

    def _BufferCore__report(
        self, kind: str, about: str, text: str, *, is_error: bool = False
    ) -> None:
        """Log a refusal once per kind and sender, as others decide how often it occurs."""
        if (kind, about) in self._BufferCore__reported or len(
            self._BufferCore__reported
        ) >= MAX_REPORTS:
            return
        self._BufferCore__reported.add((kind, about))
        text = shortened(escaped(text))
        if is_error:
            self._BufferCore__logger.error(text)
        else:
            self._BufferCore__logger.warning(text)

    def clear(self) -> None:
        """Clear the history of all frames; static transforms and frame names are kept."""
        for frame in self._BufferCore__frames.values():
            frame.clear()
        self._BufferCore__routes.forget()

    # Looking up

    def lookup_transform_core(
        self, target_frame: str, source_frame: str, time: Any
    ) -> TransformStamped:
        """Return the transform that expresses in `target_frame` what is given in `source_frame`.

        Raises:
            LookupException: a frame does not exist, or the tree has a loop.
            ConnectivityException: the frames are in different trees.
            ExtrapolationException: there is no data for the time.
            InvalidArgumentException: a name is empty or begins with a slash.
        """
        time_ns = time_ns_of(time)
        route = self._BufferCore__routes.find(target_frame, source_frame)
        if route is not None:  # so both frames exist
            stamp_ns = time_ns or route.latest_ns()
            pose = route.pose(stamp_ns)
            if pose is not None:
                return self._BufferCore__message(target_frame, source_frame, unit(pose), stamp_ns)
        pose, stamp_ns = self._BufferCore__lookup(target_frame, source_frame, time_ns)
        return self._BufferCore__message(target_frame, source_frame, unit(pose), stamp_ns)

    def lookup_transform_full_core(
        self,
        target_frame: str,
        target_time: Any,
        source_frame: str,
        source_time: Any,
        fixed_frame: str,
    ) -> TransformStamped:
        """Return the transform from a source frame at one time to a target frame at another.

        Args:
            target_frame: The frame to transform to.
            target_time: The time in the target frame.
            source_frame: The frame to transform from.
            source_time: The time in the source frame.
            fixed_frame: The frame that is fixed between the two times.

        Raises:
            TransformException: as `lookup_transform_core`.
        """
        for argument, frame in (
            ("target_frame", target_frame),
            ("source_frame", source_frame),
            ("fixed_frame", fixed_frame),
        ):
            self._BufferCore__expect_frame(f"lookupTransform argument {argument}", frame)
        inner, _ = self._BufferCore__lookup(fixed_frame, source_frame, time_ns_of(source_time))
        outer, stamp_ns = self._BufferCore__lookup(
            target_frame, fixed_frame, time_ns_of(target_time)
        )
        pose = unit(composed(unit(outer), unit(inner)))
        return self._BufferCore__message(target_frame, source_frame, pose, stamp_ns)

    def can_transform_core(
        self, target_frame: str, source_frame: str, time: Any
    ) -> tuple[bool, str]:
        """Return whether the transform is available, and why not."""
        time_ns = time_ns_of(time)
        if target_frame == source_frame:
            return True, ""
        names = {"target_frame": target_frame, "source_frame": source_frame}
        problem = self._BufferCore__problem_of(names)
        if problem:
            return False, problem
        failure = walk(self._BufferCore__frames, target_frame, source_frame, time_ns).failure
        return failure is None, "" if failure is None else failure.text

    def can_transform_full_core(
        self,
        target_frame: str,
        target_time: Any,
        source_frame: str,
        source_time: Any,
        fixed_frame: str,
    ) -> tuple[bool, str]:
        """Return whether the transform between two times is available, and why not."""
        problem = self._BufferCore__problem_of(
            {
                "target_frame": target_frame,
                "source_frame": source_frame,
                "fixed_frame": fixed_frame,
            }
        )
        if problem:
            return False, problem
        for target, source, time in (
            (target_frame, fixed_frame, target_time),
            (fixed_frame, source_frame, source_time),
        ):
            failure = walk(self._BufferCore__frames, target, source, time_ns_of(time)).failure
            if failure is not None:
                return False, failure.text
        return True, ""

    def get_latest_common_time(self, target_frame: str, source_frame: str) -> Time:
        """Return the latest time at which the transform is available; 0 between static frames.

        Raises:
            LookupException: a frame does not exist.
            InvalidArgumentException: a name is empty or begins with a slash.
            TransformException: the frames are in different trees.
        """
        for frame in (target_frame, source_frame):
            self._BufferCore__expect_frame("get_latest_common_time", frame)
        latest = self._BufferCore__latest_ns(target_frame, source_frame)
        if isinstance(latest, Failure):
            raise TransformException(latest.text)
        return Time(nanoseconds=max(latest, 0))

    def lookupVelocityCore(  # tf2's name
        self, tracking_frame: str, observation_frame: str, time: Any, averaging_interval: Any
    ) -> Velocity:
        """Return the linear and angular velocity of a frame relative to another.

        Args:
            tracking_frame: The moving frame; the velocity is that of its origin.
            observation_frame: The frame it is observed from, in whose axes the result is.
            time: The middle of the interval.
            averaging_interval: The averaging interval: a Duration, or seconds.

        Raises:
            TransformException: as `lookup_transform_core`.
        """
        return self.lookupVelocityFullCore(
            tracking_frame,
            observation_frame,
            observation_frame,
            (0.0, 0.0, 0.0),
            tracking_frame,
            time,
            averaging_interval,
        )

    def lookupVelocityFullCore(  # tf2's name
        self,
        tracking_frame: str,
        observation_frame: str,
        reference_frame: str,
        reference_point: Vector,
        reference_point_frame: str,
        time: Any,
        averaging_interval: Any,
    ) -> Velocity:
        """Return the linear and angular velocity of a point that moves with a frame.

        Args:
            tracking_frame: The moving frame.
            observation_frame: The frame it is observed from.
            reference_frame: The frame in whose axes the result is.
            reference_point: The point, in `reference_point_frame`.
            reference_point_frame: The frame of the point.
            time: The middle of the interval.
            averaging_interval: The averaging interval: a Duration, or seconds.

        Raises:
            TransformException: as `lookup_transform_core`.
        """
        latest = self._BufferCore__latest_ns(observation_frame, tracking_frame)
        return velocity(
            lambda target, source, time_ns: unit(
                self._BufferCore__lookup(target, source, time_ns)[0]
            ),
            0 if isinstance(latest, Failure) else latest,
            (tracking_frame, observation_frame, reference_frame, reference_point_frame),
            reference_point,
            time_ns_of(time),
            duration_ns(averaging_interval),
        )

    # All frames

    def all_frames_as_yaml(self) -> str:
        """Return parent, broadcaster, rate and times of each frame, as YAML."""
        return frame_listing.frames_as_yaml(self._BufferCore__frames, self._BufferCore__authorities)

    def all_frames_as_string(self) -> str:
        """Return a line per frame, with its parent."""
        return frame_listing.frames_as_string(self._BufferCore__frames)

    def _allFramesAsDot(self, time: Any = None) -> str:  # tf2's name
        """Return the tree in Graphviz's language; with a time, including the age of the data."""
        now_ns = 0 if time is None else time_ns_of(time)
        return frame_listing.frames_as_dot(
            self._BufferCore__frames, self._BufferCore__authorities, now_ns
        )

    def _frameExists(self, frame_id: str) -> bool:  # tf2's name
        """Return whether a frame was ever mentioned, as child or parent."""
        return frame_id in self._BufferCore__frames.names

    def _getFrameStrings(self) -> list[str]:  # tf2's name
        """Return the names of all frames that were ever mentioned."""
        return list(self._BufferCore__frames.names)

    def _chain(
        self,
        target_frame: str,
        target_time: Any,
        source_frame: str,
        source_time: Any,
        fixed_frame: str,
    ) -> list[str]:
        """Return the frames between source and target, like tf2.

        Raises:
            TransformException: as `lookup_transform_full_core`.
        """
        return chain(
            self._BufferCore__frames,
            (target_frame, time_ns_of(target_time)),
            (source_frame, time_ns_of(source_time)),
            fixed_frame,
        )

    # Within

    def _BufferCore__lookup(self, target: str, source: str, time_ns: int) -> tuple[Pose, int]:
        """Return the pose of `source` in `target`, and its stamp."""
        if target == source:  # tf2 answers even for unknown frames
            frame = self._BufferCore__frames.get(target)
            if time_ns == 0 and frame is not None:
                time_ns = frame.newest_ns
            return Walk(time_ns).pose(), time_ns
        self._BufferCore__expect_frame("lookupTransform argument target_frame", target)
        self._BufferCore__expect_frame("lookupTransform argument source_frame", source)
        result = self._BufferCore__find(target, source, time_ns)
        if isinstance(result, Failure):
            raise result.exception()
        return result

    def _BufferCore__find(
        self, target: str, source: str, time_ns: int
    ) -> tuple[Pose, int] | Failure:
        """Return the pose of one existing frame in another, and its stamp, or why there is none."""
        route = self._BufferCore__routes.find(target, source)
        if route is not None:
            stamp_ns = time_ns or route.latest_ns()
            pose = route.pose(stamp_ns)
            if pose is not None:
                return pose, stamp_ns
        way = walk(self._BufferCore__frames, target, source, time_ns)
        return way.failure or (way.pose(), way.time_ns)

    def _BufferCore__latest_ns(self, target: str, source: str) -> int | Failure:
        """Return the latest time at which a transform is available."""
        if target == source:
            frame = self._BufferCore__frames.get(source)
            return 0 if frame is None else frame.newest_ns
        return latest_common_ns(self._BufferCore__frames, target, source)

    def _BufferCore__expect_frame(self, subject: str, frame: str) -> None:
        """Raise tf2's error if a frame does not exist."""
        if frame in self._BufferCore__frames.names:
            return
        if not frame or frame.startswith("/"):
            wrong = "cannot start with a '/'" if frame else "cannot be empty"
            raise InvalidArgumentException(
                f'Invalid argument "{frame}" passed to {subject} - in tf2 frame_ids {wrong}'
            )
        raise LookupException(f'"{frame}" passed to {subject} does not exist. ')

    def _BufferCore__problem_of(self, arguments: dict[str, str]) -> str:
        """Return why one of some frames cannot be looked up; empty if all can."""
        for argument, frame in arguments.items():
            if frame in self._BufferCore__frames.names:
                continue
            wrong = "frame does not exist"
            if not frame:
                wrong = "in tf2 frame_ids cannot be empty"
            elif frame.startswith("/"):
                wrong = "in tf2 frame_ids cannot start with a '/'"
            return (
                f'Invalid frame ID "{frame}" passed to canTransform argument {argument} - {wrong}'
            )
        return ""

    def _BufferCore__message(
        self, target: str, source: str, pose: Pose, stamp_ns: int
    ) -> TransformStamped:
        sec, nanosec = divmod(stamp_ns, S_TO_NS)
        x, y, z, i, j, k, w = pose
        # Positional, in the order of the fields; with names, as the types demand, this takes three
        # times as long.
        make: Any = TransformStamped
        header, time, whole, vector, turn = PARTS
        return make(  # type: ignore[no-any-return]  # a TransformStamped
            header(time(sec, nanosec), target),
            source,
            whole(vector(x, y, z), turn(i, j, k, w)),
        )


def frames_of(core: BufferCore) -> Tree:
    """Return the frames of a buffer by name."""
    return core._BufferCore__frames


def authorities_of(core: BufferCore) -> Mapping[str, str]:
    """Return who sent the newest transform of each frame."""
    return core._BufferCore__authorities


def rivals_of(core: BufferCore) -> Mapping[str, str]:
    """Return who sent the transforms of a frame before its authority, if that was another."""
    return core._BufferCore__rivals


PARTS: tuple[Any, ...] = (Header, TimeMsg, Transform, Vector3, Quaternion)
