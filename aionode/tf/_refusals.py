"""Transforms that tf2 rejects, with tf2's messages."""

from __future__ import annotations

from math import isnan
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from aionode.tf._arithmetic import Pose

__all__ = ["TOLERANCE", "mistakes", "old_data", "too_long", "too_many", "two_broadcasters"]

TOLERANCE = 10e-3
"""Tolerance for the squared length of a quaternion."""


def mistakes(child: str, parent: str, pose: Pose, authority: str) -> list[tuple[str, str]]:
    """Return everything that is wrong with a transform, as pairs of kind and text."""
    refusals = []
    by = f'authority "{authority}"'
    if child == parent:
        text = (
            f'Ignoring transform from {by} with frame_id and  child_frame_id "{child}" because '
            "they are the same"
        )
        refusals.append(("TF_SELF_TRANSFORM", text))
    if not child:
        text = f"Ignoring transform from {by} because child_frame_id not set "
        refusals.append(("TF_NO_CHILD_FRAME_ID", text))
    if not parent:
        text = (
            f'Ignoring transform with child_frame_id "{child}"  from {by} because frame_id not set'
        )
        refusals.append(("TF_NO_FRAME_ID", text))
    numbers = [f"{number:f}" for number in pose]
    translation, rotation = f"({' '.join(numbers[:3])})", f"({' '.join(numbers[3:])})"
    ignoring = f'Ignoring transform for child_frame_id "{child}" from {by} because of'
    if any(isnan(number) for number in pose):
        text = f"{ignoring} a nan value in the transform {translation} {rotation}"
        refusals.append(("TF_NAN_INPUT", text))
    if not abs(sum(number * number for number in pose[3:]) - 1.0) < TOLERANCE:
        text = f"{ignoring} an invalid quaternion in the transform {rotation}"
        refusals.append(("TF_DENORMALIZED_QUATERNION", text))
    return [(kind, f"{kind}: {text}") for kind, text in refusals]


def old_data(child: str, time: str, authority: str) -> str:
    """Return the text about a transform that is older than the cache time."""
    return (
        f"TF_OLD_DATA ignoring data from the past for frame {child} at time {time} according to "
        f"authority {authority}\n"
        "Possible reasons are listed at http://wiki.ros.org/tf/Errors%20explained"
    )


def too_long(limit: int, authority: str) -> str:
    """Return the text about the name of a frame that is too long."""
    return (
        f'TF_LONG_FRAME_ID: Ignoring transform from authority "{authority}" because a frame id has '
        f"more than {limit} characters"
    )


def too_many(limit: int, authority: str) -> str:
    """Return the text about a frame for which there is no room."""
    return (
        f'TF_TOO_MANY_FRAMES: Ignoring new frames from authority "{authority}" because the buffer '
        f"has {limit} frames already"
    )


def two_broadcasters(child: str, authority: str, other: str) -> str:
    """Return the text about a frame whose transforms come from two nodes in turns."""
    return (
        f'TF_TWO_BROADCASTERS: frame "{child}" is sent by {authority} and by {other} in turns, so '
        "its transform jumps between theirs; stop one of them, or rename its frame"
    )
