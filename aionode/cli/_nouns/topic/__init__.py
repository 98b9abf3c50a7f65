"""``aionode topic``: list, inspect and publish; `echo`, `measure` and `plot` contain the rest."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Any

import click

from aionode.cli._nouns.topic.echo import echoing, name_option, qos_from, qos_options
from aionode.cli._nouns.topic.measure import measuring
from aionode.cli._nouns.topic.plot import plotting
from aionode.cli._support import lookup
from aionode.cli._support.command import add_type_and_find, command
from aionode.cli._support.completion import name_argument, values_parameters
from aionode.cli._support.follow import Follower
from aionode.cli._support.formatting import endpoint_record, endpoint_text, names_text
from aionode.cli._support.nouns import TOPIC, with_types
from aionode.cli._support.options import (
    count_option,
    hertz,
    hidden_option,
    positive,
    read_values,
    seconds,
    types_option,
    verbose_option,
    whole,
)
from aionode.cli._support.yaml_messages import Filler
from aionode.errors import CommandError
from aionode.graph import TOPIC_KINDS, EndpointKind
from aionode.message import to_json
from aionode.qos import qos_profile_default

if TYPE_CHECKING:
    from aionode.cli._support.output import Output
    from aionode.endpoints.publisher import Publisher
    from aionode.graph import EndpointInfo
    from aionode.node import Node
    from aionode.qos import QoSProfile

__all__ = ["info", "list_topics", "pub", "topic_command"]


@click.group("topic", commands={**echoing.commands, **measuring.commands, **plotting.commands})
def topic_command() -> None:
    """List, print, publish, measure and plot topics."""


add_type_and_find(topic_command, TOPIC)


@command(
    topic_command,
    "list",
    types_option,
    count_option("topics"),
    hidden_option("--include-hidden-topics", what="topics"),
    click.option(
        "-v", "--verbose", is_flag=True, help="Print the number of publishers and subscribers."
    ),
)
async def list_topics(
    node: Node,
    *,
    output: Output,
    types: bool = False,
    count: bool = False,
    hidden: bool = False,
    verbose: bool = False,
) -> None:
    """List the topics that have a publisher or a subscription."""
    types_by_name = TOPIC.types_by_name(node, hidden=hidden)
    numbers = {
        name: {kind: len(lookup.endpoints(node, kind, name=name)) for kind in TOPIC_KINDS}
        for name in types_by_name
    }
    if verbose and not (count or output.json):
        output.text(
            verbose_text("Published", "publisher", EndpointKind.PUBLISHER, types_by_name, numbers)
        )
        output.text(
            verbose_text(
                "Subscribed", "subscriber", EndpointKind.SUBSCRIPTION, types_by_name, numbers
            )
        )
        return
    items = [
        (
            with_types(name, of) if types else name,
            {
                "name": name,
                "types": of,
                "publishers": numbers[name][EndpointKind.PUBLISHER],
                "subscriptions": numbers[name][EndpointKind.SUBSCRIPTION],
            },
        )
        for name, of in types_by_name.items()
    ]
    output.items(items, count="topics" * count)


def verbose_text(
    title: str,
    word: str,
    kind: EndpointKind,
    types_by_name: dict[str, list[str]],
    numbers: dict[str, dict[EndpointKind, int]],
) -> str:
    """Return text that lists the topics with endpoints of one kind, and how many there are."""
    text = f"{title} topics:\n"
    for name, types in types_by_name.items():
        if number := numbers[name][kind]:
            plural = "s" if number > 1 else ""
            text += f" * {with_types(name, types)} {number} {word}{plural}\n"
    return text


@command(
    topic_command,
    "info",
    name_argument("topic"),
    verbose_option,
)
async def info(node: Node, topic_name: str, *, output: Output, verbose: bool = False) -> None:
    """Print the type of a topic, and its publishers and subscriptions.

    Raises:
        CommandError: the topic does not exist.
    """
    name = TOPIC.resolve(node, topic_name)
    publishers = lookup.endpoints(node, EndpointKind.PUBLISHER, name=name)
    subscriptions = lookup.endpoints(node, EndpointKind.SUBSCRIPTION, name=name)
    if not (publishers or subscriptions):
        raise TOPIC.unknown(node, topic_name)
    types = sorted({user.type_name for user in (*publishers, *subscriptions)})
    if output.json:
        output.item("", info_record(name, types, publishers, subscriptions, verbose=verbose))
        return
    end = "\n" if verbose else ""
    output.text(f"Type: {names_text(types)}{end}")
    for title, users in (("Publisher", publishers), ("Subscription", subscriptions)):
        output.text(f"{title} count: {len(users)}{end}")
        for user in users if verbose else ():
            output.text(f"{endpoint_text(user)}\n")


def info_record(
    name: str,
    types: list[str],
    publishers: list[EndpointInfo],
    subscriptions: list[EndpointInfo],
    *,
    verbose: bool,
) -> dict[str, Any]:
    """Return the record of a topic."""
    record: dict[str, Any] = {"name": name, "types": types}
    for word, users in (("publishers", publishers), ("subscriptions", subscriptions)):
        record[word] = [endpoint_record(user) for user in users] if verbose else len(users)
    return record


# Publishing


def prepare_pub(options: dict[str, Any]) -> None:
    """Check the options of ``pub`` that depend on each other, and read the values."""
    once = options.pop("once")
    if once and options["times"]:
        raise click.UsageError("Give --once or --times, not both.")
    if once:
        options["times"] = 1
    if options["wait_for"] is None:
        options["wait_for"] = min(options["times"], 1)
    if options["max_wait_s"] is not None and options["wait_for"] == 0:
        raise click.UsageError(
            "--max-wait-time-secs needs --wait-matching-subscriptions, --once or --times."
        )
    options["qos"] = qos_from("default", options)
    read_values(options)


@command(
    topic_command,
    "pub",
    *values_parameters("topic"),
    click.option(
        "-r",
        "--rate",
        metavar="N",
        type=hertz,
        default=1.0,
        show_default=True,
        help="Publishing rate, in Hz.",
    ),
    click.option(
        "-p", "--print", "print_nth", metavar="N", type=whole, default=1,
        help="Print only every N-th message.",
    ),
    click.option("-1", "--once", is_flag=True, help="Publish one message and exit."),
    click.option(
        "-t", "--times", metavar="N", type=whole, default=0,
        help="Publish N messages and exit.",
    ),
    click.option(
        "-w", "--wait-matching-subscriptions", "wait_for", metavar="N", type=whole,
        help="Wait for N subscriptions first (default: 1 with --once or --times, else 0).",
    ),
    click.option(
        "--max-wait-time-secs", "max_wait_s", metavar="N", type=positive,
        help="Wait at most N seconds for subscriptions.",
    ),
    click.option(
        "--keep-alive", "keep_alive_s", metavar="N", type=seconds, default=0.1,
        show_default=True, help="Keep the node alive for N seconds after the last message.",
    ),
    name_option("publishing"),
    *qos_options("default"),
    interfaces=True,
    sim_time=True,
    prepare=prepare_pub,
    endless=lambda options: options["times"] == 0,
    busy=True,
    asks=False,
)  # fmt: skip
async def pub(
    node: Node,
    topic_name: str,
    message_type: str,
    *,
    output: Output,
    values: str = "{}",
    rate: float = 1.0,
    print_nth: int = 1,
    times: int = 0,
    wait_for: int = 0,
    max_wait_s: float | None = None,
    keep_alive_s: float = 0.1,
    qos: QoSProfile | None = None,
) -> None:
    """Publish messages given in YAML, such as '{data: hello}'.

    A Header given as auto and a Time given as now are set to the time of publishing.

    Raises:
        CommandError: the type or values are invalid, or too few subscriptions appeared.
        InvalidTopicNameException: the name is invalid.
    """
    name = node.resolve_topic_name(topic_name)
    msg_type = await lookup.topic_type(node, name, message_type)
    assert msg_type is not None  # noqa: S101  # a type was given
    filler = Filler(msg_type, values)
    publisher: Publisher[Any] = node.create_publisher(msg_type, name, qos or qos_profile_default)
    await wait_for_subscriptions(publisher, wait_for, max_wait_s, output)
    output.text("publisher: beginning loop")
    follower = Follower(node)
    count = 0

    def publish() -> None:
        nonlocal count
        msg = filler.message(node.get_clock().now())
        count += 1
        if print_nth and count % print_nth == 0:
            if output.json:
                output.json_line(to_json(msg))
            else:
                output.text(f"publishing #{count}: {msg!r}\n")
        publisher.publish(msg)
        if count == times:
            timer.cancel()
            follower.finish()

    timer = node.create_timer(1.0 / rate, publish, on_error=follower.fail)
    publish()
    await follower.finished()
    await publisher.drain()
    await node.get_clock().sleep(keep_alive_s)


async def wait_for_subscriptions(
    publisher: Publisher[Any],
    wanted: int,
    max_wait_s: float | None,
    output: Output,
) -> None:
    """Wait until `wanted` subscriptions match.

    Raises:
        CommandError: fewer matched within `max_wait_s`.
    """
    if publisher.get_subscription_count() >= wanted:
        return
    text = f"Waiting for at least {wanted} matching subscription(s)..."
    output.progress(text)
    try:
        with output.waiting(text):
            async with asyncio.timeout(max_wait_s):
                await publisher.wait_for_subscribers(wanted)
    except TimeoutError:
        raise CommandError(
            f"Timed out waiting for subscribers of '{publisher.topic_name}': expected {wanted}, "
            f"but only got {publisher.get_subscription_count()} in {max_wait_s:g} s; "
            "use --wait-matching-subscriptions 0 to publish without waiting"
        ) from None
