"""The common options of ``aionode bag``: topics, times and QoS."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, TypeVar

import click

from aionode.clock import Clock, ClockType, Duration

if TYPE_CHECKING:
    from collections.abc import Sequence

    from aionode.bag import Selection
    from aionode.qos import QoSProfile

__all__ = [
    "TOPICS",
    "bag_names",
    "checked_selection",
    "names",
    "option_from",
    "output_folder",
    "overrides",
    "selection_of",
    "selection_options",
    "spread",
    "time_span",
]

T = TypeVar("T")

Decorator = Callable[[Any], Any]

LENGTH = re.compile(r"(\d+(?:\.\d+)?)\s*(ns|us|ms|s|m|min|h)?")
UNITS = {"ns": 1e-9, "us": 1e-6, "ms": 1e-3, "s": 1.0, "m": 60.0, "min": 60.0, "h": 3600.0}


class Names(click.Option):
    """An option that takes all values up to the next option, as in ros2: ``--topics /a /b``."""

    def add_to_parser(self, parser: Any, ctx: click.Context) -> None:
        """Make the parser consume the values that follow."""
        super().add_to_parser(parser, ctx)
        for name in self.opts:
            option = parser._long_opt.get(name) or parser._short_opt.get(name)
            if option is not None:
                option.process = taking_all(option, option.process)


def taking_all(option: Any, process: Callable[[Any, Any], None]) -> Callable[[Any, Any], None]:
    """Return a function that takes a value and those after it, up to the next option."""

    def take(value: Any, state: Any) -> None:
        process(value, state)
        while state.rargs and not state.rargs[0].startswith("-"):
            process(state.rargs.pop(0), state)

    return take


def names(*flags: str, what: str) -> Decorator:
    """Return an option for one or more names."""
    return click.option(*flags, multiple=True, cls=Names, help=what)


TOPICS = names("--topics", what="Topic names.")


def bag_names(given: Sequence[str]) -> list[str]:
    """Return the bags of an option; in rosbag2 each may be followed by its storage format."""
    return [name for name in given if name not in {"mcap", "sqlite3"}]


def spread(options: Sequence[Decorator]) -> Decorator:
    """Return a decorator that adds several options."""

    def add(command: Any) -> Any:
        for option in reversed(options):
            command = option(command)
        return command

    return add


def selection_options(*, playing: bool) -> Decorator:
    """Return the options that select topics."""
    excluding = ["-x", "--exclude-regex"] if playing else ["--exclude-regex"]
    options = [
        TOPICS,
        names("--services", what="Service names."),
        names("--actions", what="Action names."),
        click.option("-e", "--regex", default="", help="Only names that match this pattern."),
        click.option(*excluding, default="", help="Exclude names that match this pattern."),
        names("--exclude-topics", what="Topics to exclude."),
        names("--exclude-services", what="Services to exclude."),
        names("--exclude-actions", what="Actions to exclude."),
    ]
    if not playing:
        options += [
            click.option(
                "-a", "--all", "everything", is_flag=True, help="All topics, services and actions."
            ),
            click.option("--all-topics", is_flag=True, help="All topics."),
            click.option("--all-services", is_flag=True, help="All services."),
            click.option("--all-actions", is_flag=True, help="All actions."),
            names("--topic-types", what="Only topics of these types."),
            names("--exclude-topic-types", what="Types to exclude."),
            click.option("--include-hidden-topics", is_flag=True, help="Include hidden topics."),
        ]
    return spread(options)


def selection_of(values: dict[str, Any], *, everything: bool) -> Selection:
    """Return the selection of topics; everything if none are named and `everything` is set."""
    from aionode.bag import Selection

    kinds = ("topic", "service", "action")
    every = [kind for kind in kinds if values.get("everything") or values.get(f"all_{kind}s")]
    named = [values[name] for name in ("topics", "services", "actions", "regex")]
    if everything and not any(named):
        every = list(kinds)
    return Selection(
        topics=[absolute(name) for name in values["topics"]],
        services=[absolute(name) for name in values["services"]],
        actions=[absolute(name) for name in values["actions"]],
        types=values.get("topic_types", ()),
        regex=values["regex"],
        every=every,
        exclude_regex=values["exclude_regex"],
        exclude=[absolute(name) for kind in kinds for name in values[f"exclude_{kind}s"]],
        exclude_types=values.get("exclude_topic_types", ()),
        hidden=values.get("include_hidden_topics", False) or everything,
    )


def absolute(name: str) -> str:
    """Return a name with its leading slash."""
    return f"/{name.removeprefix('/')}"


def checked_selection(values: dict[str, Any]) -> Selection:
    """Return the selection of topics to record.

    Raises:
        click.UsageError: no topics are selected.
    """
    selection = selection_of(values, everything=False)
    wanted = (
        selection.every,
        selection.topics,
        selection.services,
        selection.actions,
        selection.types,
        selection.regex,
    )
    if not any(wanted):
        raise click.UsageError(
            "Need to specify at least one option out of --all, --all-topics, --all-services, "
            "--all-actions, --topics, --services, --actions, --topic-types, --regex"
        )
    return selection


def output_folder() -> str:
    """Return a folder name with the time, as rosbag2 chooses it."""
    from datetime import UTC, datetime

    seconds = Clock(clock_type=ClockType.SYSTEM_TIME).now().nanoseconds / 1e9
    local = datetime.fromtimestamp(seconds, UTC).astimezone()
    return local.strftime("rosbag2_%Y_%m_%d-%H_%M_%S")


def option_from(read: Callable[..., T], *values: Any) -> T:
    """Apply a function to the value of an option, such as one that reads a file.

    Raises:
        click.BadParameter: the function rejects the value.
    """
    try:
        return read(*values)
    except ValueError as error:
        raise click.BadParameter(str(error)) from error


def overrides(path: str | None) -> dict[str, QoSProfile]:
    """Return the profiles in a YAML file, by topic.

    Raises:
        click.BadParameter: the file has none.
    """
    if path is None:
        return {}
    from aionode.bag import qos_overrides

    try:
        return qos_overrides(path)
    except ValueError as error:
        raise click.BadParameter(f"{path}: {error}") from error


def time_span(values: dict[str, Any]) -> tuple[Duration | None, Duration | None]:
    """Return the start and the end, counted from the start of the bag.

    Raises:
        click.UsageError: both the end and the duration are given.
    """
    start, end, length = (length_of(values[name]) for name in ("start", "end", "duration"))
    if end is not None and length is not None:
        raise click.UsageError("--end and --duration cannot be combined")
    if length is not None:
        end = length if start is None else start + length
    return start, end


def length_of(text: str | None) -> Duration | None:
    """Parse a duration, such as ``10s``, ``1.5`` or ``2min``."""
    if text is None:
        return None
    match = LENGTH.fullmatch(text.strip())
    if match is None:
        raise click.BadParameter(
            f"{text!r} is not a duration; expected one such as 10s, 500ms or 2min"
        )
    return Duration(seconds=float(match[1]) * UNITS[match[2] or "s"])
