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
        """Make the parser take the values that follow."""
        super().add_to_parser(parser, ctx)
        for name in self.opts:
            option = parser._long_opt.get(name) or parser._short_opt.get(name)
            if option is not None:
                option.process = taking_all(option, option.process)


def taking_all(option: Any, process: Callable[[Any, Any], None]) -> Callable[[Any, Any], None]:
    """Return what takes a value and those after it, up to the next option."""

    def take(value: Any, state: Any) -> None:
        process(value, state)
        while state.rargs and not state.rargs[0].startswith("-"):
            process(state.rargs.pop(0), state)

    return take


def names(*flags: str, what: str) -> Decorator:
    """Return an option for one or more names."""
    return click.option(*flags, multiple=True, cls=Names, help=what)


TOPICS = names("--topics", what="Names of topics.")


def bag_names(given: Sequence[str]) -> list[str]:
    """Return the bags that an option names; rosbag2 has the storage after each of them."""
    return [name for name in given if name not in {"mcap", "sqlite3"}]


def spread(options: Sequence[Decorator]) -> Decorator:
    """Return the decorator that adds several options."""

    def add(command: Any) -> Any:
        for option in reversed(options):
            command = option(command)
        return command

    return add


def selection_options(*, playing: bool) -> Decorator:
    """Return the options that say which topics are wanted."""
    excluding = ["-x", "--exclude-regex"] if playing else ["--exclude-regex"]
    options = [
        TOPICS,
        names("--services", what="Names of services."),
        names("--actions", what="Names of actions."),
        click.option("-e", "--regex", default="", help="What names match that are wanted."),
        click.option(*excluding, default="", help="What names match that are not wanted."),
        names("--exclude-topics", what="Names of topics that are not wanted."),
        names("--exclude-services", what="Names of services that are not wanted."),
        names("--exclude-actions", what="Names of actions that are not wanted."),
    ]
    if not playing:
        options += [
            click.option("-a", "--all", "everything", is_flag=True, help="All of them."),
            click.option("--all-topics", is_flag=True, help="All topics."),
            click.option("--all-services", is_flag=True, help="All services."),
            click.option("--all-actions", is_flag=True, help="All actions."),
            names("--topic-types", what="Names of types."),
            names("--exclude-topic-types", what="Names of types that are not wanted."),
            click.option("--include-hidden-topics", is_flag=True, help="Hidden topics as well."),
        ]
    return spread(options)


def selection_of(values: dict[str, Any], *, everything: bool) -> Selection:
    """Return which topics are wanted, everything if none are named and that is meant."""
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
    """Return a name with its slash."""
    return f"/{name.removeprefix('/')}"


def checked_selection(values: dict[str, Any]) -> Selection:
    """Return which topics are to be recorded.

    Raises:
        click.UsageError: none are named.
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
    """Return the name of a folder with the time, as rosbag2 gives it."""
    from datetime import UTC, datetime

    seconds = Clock(clock_type=ClockType.SYSTEM_TIME).now().nanoseconds / 1e9
    local = datetime.fromtimestamp(seconds, UTC).astimezone()
    return local.strftime("rosbag2_%Y_%m_%d-%H_%M_%S")


def option_from(read: Callable[..., T], *values: Any) -> T:
    """Return what a function makes of an option, such as the content of a file.

    Raises:
        click.BadParameter: it does not fit.
    """
    try:
        return read(*values)
    except ValueError as error:
        raise click.BadParameter(str(error)) from error


def overrides(path: str | None) -> dict[str, QoSProfile]:
    """Return the profiles in a YAML file, by topic.

    Raises:
        click.BadParameter: there are none in it.
    """
    if path is None:
        return {}
    from aionode.bag import qos_overrides

    try:
        return qos_overrides(path)
    except ValueError as error:
        raise click.BadParameter(f"{path}: {error}") from error


def time_span(values: dict[str, Any]) -> tuple[Duration | None, Duration | None]:
    """Return from when to when, after the start of the bag.

    Raises:
        click.UsageError: both the end and the length are given.
    """
    start, end, length = (length_of(values[name]) for name in ("start", "end", "duration"))
    if end is not None and length is not None:
        raise click.UsageError("--end and --duration exclude each other")
    if length is not None:
        end = length if start is None else start + length
    return start, end


def length_of(text: str | None) -> Duration | None:
    """Return a length of time, such as ``10s``, ``1.5`` or ``2min``."""
    if text is None:
        return None
    match = LENGTH.fullmatch(text.strip())
    if match is None:
        raise click.BadParameter(f"{text!r} is no length of time, such as 10s, 500ms or 2min")
    return Duration(seconds=float(match[1]) * UNITS[match[2] or "s"])
