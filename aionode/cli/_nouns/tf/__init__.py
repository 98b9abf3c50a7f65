"""``aionode tf``: transforms between coordinate frames."""

from __future__ import annotations

from math import degrees
from typing import TYPE_CHECKING, Any

import click

from aionode.cli._nouns.tf.tree import as_svg, as_text, edges_of
from aionode.cli._support.command import command
from aionode.cli._support.options import hertz, seconds
from aionode.clock import Clock, ClockType, Time
from aionode.errors import TransformException
from aionode.tf import Buffer, StaticTransformBroadcaster, TimeoutException
from aionode.tf.apply import angles_of, given_transform, matrix_of, pose_of

if TYPE_CHECKING:
    from aionode.cli._support.output import Output
    from aionode.interfaces.geometry_msgs.msg import TransformStamped
    from aionode.node import Node

__all__ = ["echo", "list_frames", "send_static", "tf_command", "tree"]

WAITING_S = 1.0
"""Interval between reports of what `echo` is waiting for, in seconds."""

LATEST = Time()

LISTEN_S = 2.0
"""Time to listen to /tf, in seconds: long enough for transforms sent once a second."""


namespace_option = click.option(
    "--namespace", default="",
    help="Namespace of /tf, if robots remap it, such as /robot7.",
)  # fmt: skip


def buffer_in(node: Node, namespace: str) -> Buffer:
    """Return a buffer of the transforms in a namespace; the default is the global one."""
    inside = f"/{namespace.strip('/')}".rstrip("/")
    return Buffer(node, tf_topic=f"{inside}/tf", tf_static_topic=f"{inside}/tf_static")


@click.group("tf")
def tf_command() -> None:
    """Show and publish transforms between coordinate frames."""


@command(
    tf_command,
    "echo",
    click.argument("source_frame"),
    click.argument("target_frame"),
    click.argument("rate", type=hertz, default=1.0),
    namespace_option,
    sim_time=True,
    endless=True,
)
async def echo(
    node: Node,
    source_frame: str,
    target_frame: str,
    rate: float,
    *,
    output: Output,
    namespace: str = "",
) -> None:
    """Print the transform between two frames, RATE times a second, as tf2_echo does.

    It is the pose of TARGET_FRAME in SOURCE_FRAME.
    """
    buffer = buffer_in(node, namespace)
    while True:
        try:
            await buffer.wait_for_transform(source_frame, target_frame, timeout_sec=WAITING_S)
            break
        except TimeoutException:
            _, reason = buffer.can_transform_core(source_frame, target_frame, LATEST)
            text = f"Waiting for transform {source_frame} ->  {target_frame}: {reason}"
            output.warn(text)
    while True:
        try:
            transform = buffer.lookup_transform(source_frame, target_frame)
        except TransformException as error:
            output.warn(f"Exception thrown: {error}")
        else:
            output.item(echo_text(transform), record_of(transform))
        await node.get_clock().sleep(1 / rate)


def echo_text(transform: TransformStamped) -> str:
    """Return a transform as tf2_echo prints it."""
    stamp, moved, turned = (
        transform.header.stamp,
        transform.transform.translation,
        transform.transform.rotation,
    )
    matrix = matrix_of(pose_of(transform))
    angles = angles_of(matrix)
    rows = [
        *([*row, offset] for row, offset in zip(matrix, (moved.x, moved.y, moved.z), strict=True)),
        [0.0, 0.0, 0.0, 1.0],
    ]
    return "\n".join(
        [
            f"At time {stamp.sec}.{stamp.nanosec}",
            f"- Translation: {listed(moved.x, moved.y, moved.z)}",
            f"- Rotation: in Quaternion {listed(turned.x, turned.y, turned.z, turned.w)}",
            f"- Rotation: in RPY (radian) {listed(*angles)}",
            f"- Rotation: in RPY (degree) {listed(*map(degrees, angles))}",
            "- Matrix:",
            *("".join(f" {number:6.3f}" for number in row) for row in rows),
        ]
    )


def listed(*numbers: float) -> str:
    """Return numbers with three decimals, in brackets."""
    return f"[{', '.join(f'{number:.3f}' for number in numbers)}]"


def record_of(transform: TransformStamped) -> dict[str, Any]:
    """Return a transform as a record."""
    stamp, moved, turned = (
        transform.header.stamp,
        transform.transform.translation,
        transform.transform.rotation,
    )
    return {
        "parent": transform.header.frame_id,
        "child": transform.child_frame_id,
        "sec": stamp.sec,
        "nanosec": stamp.nanosec,
        "translation": [moved.x, moved.y, moved.z],
        "rotation": [turned.x, turned.y, turned.z, turned.w],
        "rpy": list(angles_of(matrix_of(pose_of(transform)))),
    }


seconds_option = click.option(
    "--seconds", "listen_s", type=seconds, default=LISTEN_S, show_default=True,
    help="How long to listen, in seconds.",
)  # fmt: skip


async def heard(node: Node, namespace: str, listen_s: float, output: Output) -> Buffer:
    """Return a buffer that has listened for a while."""
    buffer = buffer_in(node, namespace)
    topic = buffer.listener.tf_sub.topic_name
    with output.waiting(f"listening to {topic} for {listen_s:g} s"):
        await Clock(ClockType.STEADY_TIME, time_base=node.context.time_base).sleep(listen_s)
    return buffer


@command(tf_command, "list", namespace_option, seconds_option)
async def list_frames(
    node: Node, *, output: Output, namespace: str = "", listen_s: float = LISTEN_S
) -> None:
    """List all frames."""
    buffer = await heard(node, namespace, listen_s, output)
    output.items([(name, {"frame": name}) for name in sorted(buffer._getFrameStrings())])


@command(
    tf_command,
    "tree",
    click.option("--dot", is_flag=True, help="Print it in Graphviz format, as view_frames does."),
    click.option("--svg", is_flag=True, help="Print it as an SVG image."),
    namespace_option,
    seconds_option,
    sim_time=True,
)
async def tree(
    node: Node,
    *,
    output: Output,
    dot: bool = False,
    svg: bool = False,
    namespace: str = "",
    listen_s: float = LISTEN_S,
) -> None:
    """Print the tree of frames, with the rate, age and broadcaster of each."""
    buffer = await heard(node, namespace, listen_s, output)
    now = node.get_clock().now()
    edges = edges_of(buffer, now.nanoseconds)
    records = [edge.record() for edge in edges]
    if output.json:
        output.items([("", record) for record in records])
    elif dot:
        output.raw(f"{buffer._allFramesAsDot(now)}\n")
    elif svg:
        output.raw(as_svg(edges))
    else:
        topics = buffer.listener.tf_sub.topic_name, buffer.listener.tf_static_sub.topic_name
        output.text(as_text(edges) or f"no transforms on {' or '.join(topics)}")


def number_option(name: str, text: str) -> Any:
    """Return the declaration of a numeric option."""
    return click.option(f"--{name}", type=float, default=None, help=text)


@command(
    tf_command,
    "static",
    number_option("x", "Translation, in metres."),
    number_option("y", "Translation, in metres."),
    number_option("z", "Translation, in metres."),
    number_option("qx", "Quaternion of the rotation."),
    number_option("qy", "Quaternion of the rotation."),
    number_option("qz", "Quaternion of the rotation."),
    number_option("qw", "Quaternion of the rotation."),
    number_option("roll", "Rotation around x, in radians."),
    number_option("pitch", "Rotation around y, in radians."),
    number_option("yaw", "Rotation around z, in radians."),
    click.option("--frame-id", required=True, help="The parent frame."),
    click.option("--child-frame-id", required=True, help="The child frame."),
    endless=True,
    asks=False,
)
async def send_static(
    node: Node, frame_id: str, child_frame_id: str, *, output: Output, **numbers: float | None
) -> None:
    """Publish a static transform until Ctrl-C, with the options of static_transform_publisher.

    Raises:
        UsageError: both a quaternion and angles are given, or the transform is not valid.
    """
    msg = static_transform(frame_id, child_frame_id, numbers)
    StaticTransformBroadcaster(node).sendTransform(msg)
    output.text(
        f"Spinning until stopped - publishing transform from '{frame_id}' to '{child_frame_id}'"
    )
    await node.until_destroyed()


def static_transform(
    frame_id: str, child_frame_id: str, numbers: dict[str, float | None]
) -> TransformStamped:
    """Return the transform described by the options."""
    from aionode.interfaces.geometry_msgs.msg import (
        Quaternion,
        Transform,
        TransformStamped,
        Vector3,
    )
    from aionode.interfaces.std_msgs.msg import Header

    given = {name: number for name, number in numbers.items() if number is not None}
    try:
        (x, y, z), (i, j, k, w) = given_transform(given)
    except ValueError as error:
        raise click.UsageError(str(error)) from error
    if not frame_id.removeprefix("/") or frame_id == child_frame_id or not child_frame_id:
        raise click.UsageError("--frame-id and --child-frame-id must be different")
    if abs(i * i + j * j + k * k + w * w - 1.0) >= 0.01:
        raise click.UsageError(
            "the quaternion is not normalized (length 1), so every buffer rejects it"
        )
    return TransformStamped(
        header=Header(frame_id=frame_id),
        child_frame_id=child_frame_id,
        transform=Transform(
            translation=Vector3(x=x, y=y, z=z), rotation=Quaternion(x=i, y=j, z=k, w=w)
        ),
    )
