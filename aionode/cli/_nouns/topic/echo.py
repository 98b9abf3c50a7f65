"""``aionode topic echo``, and the options that it shares with ``pub``."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from aionode.cli._support import lookup
from aionode.cli._support.command import command
from aionode.cli._support.completion import (
    beginning,
    class_named,
    name_argument,
    type_argument,
    types_now,
)
from aionode.cli._support.follow import Follower, filter_from
from aionode.cli._support.formatting import Printer
from aionode.cli._support.options import (
    CommandT,
    clear_full_length,
    csv_option,
    filter_option,
    positive,
    print_options,
    whole,
)
from aionode.clock import Duration
from aionode.errors import CommandError
from aionode.graph import TOPIC_KINDS, EndpointKind
from aionode.qos import (
    DurabilityPolicy,
    HistoryPolicy,
    LivelinessPolicy,
    QoSPresetProfiles,
    ReliabilityPolicy,
    qos_profile_sensor_data,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence
    from enum import Enum

    from aionode.cli._support.output import Output
    from aionode.endpoints.subscription import MessageInfo, Subscription
    from aionode.graph import EndpointInfo
    from aionode.node import Node
    from aionode.qos import QoSProfile

__all__ = ["echo", "echoing", "name_option", "qos_from", "qos_options"]

DEPTH = 1000
"""Default queue depth: the maximum number of messages waiting to be printed."""

echoing = click.Group("topic")
"""The command of this module, which the group ``topic`` includes."""


# Options, including those for publishers


def name_option(whose: str) -> Callable[[CommandT], CommandT]:
    """Return the option for the name of the command's own node."""
    return click.option(
        "-n", "--node-name", "own_name", help=f"Name of the {whose} node (default: a hidden one)."
    )


POLICIES = {
    "history": HistoryPolicy,
    "reliability": ReliabilityPolicy,
    "durability": DurabilityPolicy,
    "liveliness": LivelinessPolicy,
}
"""The QoS policies that have their own option."""


def qos_options(preset: str) -> tuple[Callable[[CommandT], CommandT], ...]:
    """Return the options for a QoS profile that starts from `preset`."""

    def short_keys(kind: Any) -> click.Choice[str]:
        return click.Choice([k for k in kind.short_keys() if k != "unknown"], case_sensitive=False)

    return (
        click.option(
            "--qos-profile",
            type=short_keys(QoSPresetProfiles),
            help=f"Preset to start from (default: {preset}).",
        ),
        click.option("--qos-depth", type=whole, help="Queue length."),
        *(click.option(f"--qos-{name}", type=short_keys(kind)) for name, kind in POLICIES.items()),
        click.option("--qos-liveliness-lease-duration-seconds", type=positive, metavar="N"),
    )


def qos_from(preset: str, options: dict[str, Any]) -> QoSProfile | None:
    """Remove the options of `qos_options` from `options` and return their profile.

    Returns None if the user gave none of them.
    """
    names = ("profile", "depth", *POLICIES, "liveliness_lease_duration_seconds")
    given = {name: options.pop(f"qos_{name}") for name in names}
    if all(value is None for value in given.values()):
        return None
    profile = QoSPresetProfiles.get_from_short_key(given["profile"] or preset).replace()
    for name, kind in POLICIES.items():
        if given[name] is not None:
            setattr(profile, name, kind.get_from_short_key(given[name]))
    if given["depth"] is not None:
        profile.depth = given["depth"]
    elif profile.durability is DurabilityPolicy.TRANSIENT_LOCAL and profile.depth == 0:
        profile.depth = 1
    if (
        given["durability"] == "transient_local"
        and given["reliability"] is given["profile"] is None
    ):
        # Over DDS, best-effort subscriptions receive none of the stored messages.
        profile.reliability = ReliabilityPolicy.RELIABLE
    lease = given["liveliness_lease_duration_seconds"]
    if lease is not None:
        profile.liveliness_lease_duration = Duration(seconds=lease)
    return profile


# Echo


def complete_fields(ctx: click.Context, param: click.Parameter, incomplete: str) -> list[str]:
    """Complete a field path for the topic given earlier on the command line."""
    # At an option without a value, click stops parsing and leaves the arguments as they are.
    given = [*ctx.args, ctx.params.get("topic_name"), ctx.params.get("message_type")]
    name, *types = list(filter(None, given)) or [""]
    if name and not types:
        types = types_now("topic", name)
    classes = [class_named(type_) for type_ in types]
    paths = [path for cls in classes if cls is not None for path in field_paths(cls)]
    return beginning(incomplete, list(dict.fromkeys(paths)))


def field_paths(cls: Any) -> Iterator[str]:
    """Yield the paths of all fields of a message class, except those inside arrays."""
    from aionode.message import fields

    for field in fields(cls):
        yield field.name
        if field.type.nested is not None and field.type.container == "single":
            yield from (f"{field.name}.{path}" for path in field_paths(field.type.nested))


def prepare_echo(options: dict[str, Any]) -> None:
    """Replace the options for the QoS profile and the array length by their values."""
    options["qos"] = qos_from("sensor_data", options)
    clear_full_length(options)


@command(
    echoing,
    "echo",
    name_argument("topic"),
    type_argument("topic", required=False),
    *qos_options("sensor_data"),
    csv_option,
    click.option(
        "--field", "fields", metavar="PATH", multiple=True, shell_complete=complete_fields,
        help="Print one field, such as pose.position or name[0]; may be repeated.",
    ),
    *print_options,
    click.option("--no-lost-messages", is_flag=True, help="Do not report lost messages."),
    click.option("--raw", is_flag=True, help="Print the serialized bytes."),
    filter_option("Print"),
    click.option(
        "--content-filter",
        metavar="EXPR",
        help="Receive only messages that pass this filter of DDS, such as 'pose.x > 1'.",
    ),
    click.option("--once", is_flag=True, help="Print one message and exit."),
    click.option("--timeout", metavar="N", type=positive, help="Exit after N seconds."),
    click.option(
        "-i",
        "--include-message-info",
        "with_info",
        is_flag=True,
        help="Print timestamps and sequence numbers too.",
    ),
    click.option("-c", "--clear", is_flag=True, help="Clear the screen before each message."),
    name_option("subscribing"),
    interfaces=True,
    sim_time=True,
    prepare=prepare_echo,
    endless=lambda options: not options["once"],
    busy=True,
)  # fmt: skip
async def echo(
    node: Node,
    topic_name: str,
    message_type: str | None = None,
    *,
    output: Output,
    qos: QoSProfile | None = None,
    fields: Sequence[str] = (),
    no_lost_messages: bool = False,
    raw: bool = False,
    filter_text: str | None = None,
    content_filter: str | None = None,
    once: bool = False,
    timeout: float | None = None,
    with_info: bool = False,
    clear: bool = False,
    **printing: Any,
) -> int:
    """Print each message of a topic, as YAML, CSV or JSON.

    Returns:
        The exit status.

    Raises:
        CommandError: the type cannot be determined, or a field or a filter is invalid.
    """
    name = node.resolve_topic_name(topic_name)
    publishers = lookup.endpoints(node, EndpointKind.PUBLISHER, name=name)
    msg_type = await lookup.topic_type(node, name, message_type)
    if msg_type is None:
        raise no_type(node, name)
    if not publishers:
        output.warn(f"WARNING: topic [{name}] does not appear to be published yet")
    printer = Printer(output, fields=fields, **printing)
    fits = filter_from(filter_text)
    follower = Follower(node)
    lost = 0

    def on_message(msg: Any, info: MessageInfo) -> None:
        nonlocal lost
        if not no_lost_messages and subscription.stats.lost > lost:
            print_lost(output, subscription, lost)
            lost = subscription.stats.lost
        if filter_text is not None and not fits(printer.part_of(msg)):
            return
        if clear:
            output.clear()
        printer.show(msg, times(info) if with_info else None)
        if once:
            follower.finish()

    profile = qos or strongest(publishers, output)
    subscription = follower.follow(
        msg_type, name, on_message, profile, raw=raw, content_filter=content_filter or ""
    )
    if not await follower.finished(timeout) and not subscription.stats.received:
        output.warn(
            f"No message on '{name}' within {timeout:g} s; "
            f"publishers: {len(lookup.endpoints(node, EndpointKind.PUBLISHER, name=name))}"
        )
        return 1
    return 0


def no_type(node: Node, name: str) -> CommandError:
    """Return the error for a topic without endpoints."""
    hint = lookup.close_to(name, lookup.names_and_types(node, *TOPIC_KINDS, hidden=True))
    return CommandError(
        f"Could not determine the type for the passed topic '{name}': it has no "
        f"publisher or subscription{hint or '.'} To wait for it, give its type: aionode topic echo "
        f"{name} std_msgs/msg/String"
    )


def print_lost(output: Output, subscription: Subscription[Any], before: int) -> None:
    """Report messages that were published but did not arrive."""
    total = subscription.stats.lost
    output.warn(
        f"A message was lost!!!\n\ttotal count change:{total - before}\n\ttotal count: {total}---"
    )


def strongest(publishers: Sequence[EndpointInfo], output: Output) -> QoSProfile:
    """Return the strongest profile that all `publishers` offer; warn where they differ."""
    profile = qos_profile_sensor_data.replace(depth=DEPTH)
    if not publishers:
        return profile

    def choose(offered: list[Enum], strong: Enum, weak: Enum) -> Any:
        if all(value is strong for value in offered):
            return strong
        if strong in offered:
            output.warn(
                f"Some, but not all, publishers are offering {type(strong).__name__}."
                f"{strong.name}. Falling back to {type(weak).__name__}.{weak.name} as it will "
                "connect to all publishers"
            )
        return weak

    return profile.replace(
        reliability=choose(
            [publisher.qos.reliability for publisher in publishers],
            ReliabilityPolicy.RELIABLE,
            ReliabilityPolicy.BEST_EFFORT,
        ),
        durability=choose(
            [publisher.qos.durability for publisher in publishers],
            DurabilityPolicy.TRANSIENT_LOCAL,
            DurabilityPolicy.VOLATILE,
        ),
    )


def times(info: MessageInfo) -> dict[str, int]:
    """Return the parts of a message's info that ros2 prints; times in nanoseconds since 1970."""
    return {
        "source_timestamp": info["source_timestamp"],
        "received_timestamp": info["received_timestamp"],
        "publication_sequence_number": info["publication_sequence_number"],
        "reception_sequence_number": info["reception_sequence_number"],
    }
