"""``aionode topic plot``: numeric fields over time, in the terminal or as a picture."""

from __future__ import annotations

import asyncio
import math
from contextlib import nullcontext
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import click

from aionode.cli._nouns.topic.measure import QOS, arrival_ns
from aionode.cli._support.bags import open_bag
from aionode.cli._support.braille import Line, chart
from aionode.cli._support.command import command
from aionode.cli._support.completion import complete_names
from aionode.cli._support.field_path import field_of
from aionode.cli._support.follow import Follower, wait_for_type
from aionode.cli._support.options import positive
from aionode.errors import CommandError, escaped

if TYPE_CHECKING:
    from collections.abc import Sequence

    from aionode.cli._support.output import Output
    from aionode.endpoints.subscription import MessageInfo, Subscription
    from aionode.node import Node

__all__ = ["plot", "plotting"]

plotting = click.Group("topic")
"""The command of this module, which the group ``topic`` includes."""

REDRAW_S: Final = 0.2

ROWS: Final = 24
"""Maximum number of rows of a chart, and their number if the output is not a terminal."""

COLUMNS: Final = 100
"""Number of characters in a row if the output is not a terminal."""


@command(
    plotting,
    "plot",
    click.argument(
        "fields", metavar="TOPIC.FIELD...", nargs=-1, required=True,
        shell_complete=complete_names("topic"),
    ),
    click.option(
        "-w", "--window", metavar="SECONDS", type=positive, default=10.0, show_default=True,
        help="Time span of the chart.",
    ),
    click.option(
        "-d", "--duration", metavar="SECONDS", type=positive, help="End after this time.",
    ),
    click.option(
        "--png", metavar="FILE", help="Write a picture at the end; needs the extra `plot`.",
    ),
    click.option("--bag", "bag_path", metavar="BAG", help="Plot a whole recording."),
    interfaces=True,
    sim_time=True,
    endless=lambda options: options["duration"] is None and options["bag_path"] is None,
    busy=True,
)  # fmt: skip
async def plot(
    node: Node,
    fields: Sequence[str],
    *,
    output: Output,
    window: float = 10.0,
    duration: float | None = None,
    png: str | None = None,
    bag_path: str | None = None,
) -> None:
    """Plot numbers in messages over time, such as /odom.twist.twist.linear.x.

    All are on one scale. A terminal shows them as they arrive; elsewhere the chart is printed at
    the end, by Ctrl-C or --duration, one for each field. --json prints each value.

    Raises:
        CommandError: a field is missing or not a number, or the picture cannot be written.
    """
    if png is not None:
        check_picture(png)
    wanted = dict.fromkeys(fields)
    is_all = bag_path is not None
    keep_ns = None if is_all or png is not None else int(window * 1e9)
    numbers = [Number(node, text, keep_ns) for text in wanted]
    end = partial(finish, [number.line for number in numbers], output, window, png, is_all=is_all)
    try:
        if bag_path is not None:
            read_bag(bag_path, numbers, output)
        else:
            await follow(node, numbers, output, window, duration)
    except asyncio.CancelledError:  # Ctrl-C is one way to end
        end()
        raise
    end()


class Number:
    """One field of the messages of a topic.

    Args:
        node: The command's node, which resolves the name.
        text: The topic and the field, as ``/odom.pose.pose.position.x``.
        keep_ns: How long its values are kept, in nanoseconds; None for all of them.

    Attributes:
        topic: The full name of the topic.
        path: The path of the field.
        line: Its values over time.
    """

    def __init__(self, node: Node, text: str, keep_ns: int | None) -> None:
        topic, dot, self.path = text.partition(".")
        if not dot or not topic or not self.path:
            raise CommandError(
                f"Invalid field '{text}': give topic and field, such as /odom.twist.twist.linear.x"
            )
        self.topic = node.resolve_topic_name(topic)
        self.line = Line(f"{self.topic}.{self.path}", keep_ns)

    def add(self, msg: Any, time_ns: int, output: Output) -> None:
        """Add the value of a message.

        Raises:
            CommandError: it has no such field, or the field is not a number.
        """
        value, type_ = field_of(msg, self.path)
        if hasattr(value, "__len__") or not hasattr(value, "__float__"):  # an array may have both
            raise CommandError(
                f"Invalid field '{self.path}': {type_ or self.topic} is not a number; name a number"
                " in it, such as twist.linear.x or ranges[0]"
            )
        number = float(value)
        self.line.add(time_ns, number)
        if output.json:
            record = {"time_ns": time_ns, "topic": self.topic, "field": self.path, "value": number}
            output.item("", record)


async def follow(
    node: Node, numbers: Sequence[Number], output: Output, window: float, duration: float | None
) -> None:
    """Draw numbers as they arrive, until the duration has passed."""
    follower = Follower(node)
    subscriptions: list[Subscription[Any]] = []
    by_topic: dict[str, list[Number]] = {}
    for number in numbers:
        by_topic.setdefault(number.topic, []).append(number)

    def on_message(own: Sequence[Number], msg: Any, info: MessageInfo) -> None:
        time_ns = arrival_ns(node, info)
        for number in own:
            number.add(msg, time_ns, output)

    async def subscribe(topic: str, own: Sequence[Number]) -> None:
        msg_type = await wait_for_type(node, topic, output, spinner=False)
        for number in own:
            if "[" not in number.path:  # an array of a message that nobody has sent is empty
                field_of(msg_type(), number.path)
        subscriptions.append(follower.follow(msg_type, topic, partial(on_message, own), QOS))

    lines = [number.line for number in numbers]
    with output.live() if output.is_terminal else nullcontext() as update:
        if update is not None:

            def redraw() -> None:
                end_ns = node.get_clock().now().nanoseconds
                update(partial(picture, lines, window, end_ns))

            node.create_timer(REDRAW_S, redraw, on_error=follower.fail)
        try:
            async with asyncio.timeout(duration):
                # Concurrently: a topic without a publisher must not hold up the others.
                await asyncio.gather(
                    follower.finished(), *(subscribe(*each) for each in by_topic.items())
                )
        except TimeoutError:
            pass
        finally:
            warn_of_dropped(subscriptions, output)


def warn_of_dropped(subscriptions: Sequence[Subscription[Any]], output: Output) -> None:
    """Report how many messages were not drawn, if any."""
    dropped = sum(subscription.stats.dropped for subscription in subscriptions)
    if dropped:
        output.warn(f"{dropped} messages arrived too fast to be drawn")


def picture(lines: Sequence[Line], window: float, end_ns: int, width: int) -> list[tuple[str, str]]:
    """Return the chart of the last seconds for a terminal."""
    import shutil  # loads three compressors

    height = min(shutil.get_terminal_size().lines - 2, ROWS)
    start_ns = end_ns - int(window * 1e9)
    return chart(lines, width=width, height=height, start_ns=start_ns, end_ns=end_ns)


def read_bag(path: str, numbers: Sequence[Number], output: Output) -> None:
    """Read the numbers of a recording.

    Raises:
        CommandError: there is no such bag, or it lacks a topic.
        BagError: it cannot be read.
    """
    with open_bag(path) as recording:
        has = set(recording.topics)
        for number in numbers:
            if number.topic not in has:
                raise CommandError(
                    f"{path}: it has no topic {number.topic}; it has: {', '.join(sorted(has))}"
                )
        for record in recording.read(topics=sorted({number.topic for number in numbers})):
            for number in numbers:
                if number.topic == record.topic:
                    number.add(record.message, record.time.nanoseconds, output)


def finish(
    lines: Sequence[Line], output: Output, window: float, png: str | None, *, is_all: bool
) -> None:
    """Print charts unless a terminal has shown them, and write the picture."""
    ends = [line.points[-1][0] for line in lines if line.points]
    if not ends:
        output.warn("no message has arrived")
        return
    end_ns = max(ends)
    start_ns = end_ns - int(window * 1e9)
    if is_all:
        start_ns = min(line.points[0][0] for line in lines if line.points)
    if is_all or not (output.is_terminal or output.json):
        for line in lines:  # without colours, several in one chart cannot be told apart
            pieces = chart(
                [line], width=COLUMNS, height=ROWS // 2, start_ns=start_ns, end_ns=end_ns
            )
            output.text("".join(text for text, _ in pieces))
    if png is not None:
        write_picture(png, lines)
        output.warn(f"{png}: written")


def check_picture(path: str) -> None:
    """Check in advance whether a picture can be written.

    Raises:
        CommandError: matplotlib or the folder is missing.
    """
    try:
        import matplotlib.figure  # noqa: F401  # slow, and few need it
    except ImportError as error:
        raise CommandError(
            "--png needs matplotlib, which is not installed: pip install 'aionode[plot]'"
        ) from error
    if not Path(path).absolute().parent.is_dir():
        raise CommandError(f"--png {path}: there is no folder {Path(path).parent}")


def write_picture(path: str, lines: Sequence[Line]) -> None:
    """Write lines as a picture.

    Raises:
        CommandError: the file cannot be written.
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=(10, 5), layout="constrained")
    axes = figure.add_subplot()
    start_ns = min(line.points[0][0] for line in lines if line.points)
    for line in lines:
        times = [(time_ns - start_ns) / 1e9 for time_ns, _ in line.points]
        values = [value if math.isfinite(value) else math.nan for _, value in line.points]
        axes.plot(times, values, label=escaped(line.name))
    axes.set_xlabel("s")
    axes.grid(visible=True)
    axes.legend()
    try:
        figure.savefig(path, format="png")
    except OSError as error:
        raise CommandError(f"--png {path}: cannot be written: {error.strerror}") from error
