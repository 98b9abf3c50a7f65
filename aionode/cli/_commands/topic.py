"""``aionode topic``: list, print, publish and measure topics."""

from __future__ import annotations

import functools
from typing import Any

import click

from aionode.cli._commands.completion import (
    complete_fields,
    complete_names,
    complete_types_of,
    complete_values,
)
from aionode.cli._commands.typed_names import add_type_and_find
from aionode.cli._support.nouns import TOPIC
from aionode.cli._support.options import (
    hertz,
    hidden_option,
    interfaces_option,
    json_option,
    natural,
    positive,
    qos_from,
    qos_options,
    ros2_options,
    seconds,
    sim_time_option,
    stdin_text,
    whole,
    window_option,
)
from aionode.cli._support.session import run_verb
from aionode.cli._verbs import topic as topic_verbs

__all__ = ["topic"]

topic_argument = click.argument("topic_name", shell_complete=complete_names("topic"))


@click.group()
def topic() -> None:
    """List, print, publish and measure topics."""


@topic.command("list")
@click.option("-t", "--show-types", "types", is_flag=True, help="Print the types too.")
@click.option("-c", "--count-topics", "count", is_flag=True, help="Print only how many there are.")
@hidden_option("--include-hidden-topics", what="topics")
@click.option(
    "-v", "--verbose", is_flag=True, help="Print the numbers of publishers and subscribers."
)
@json_option
@ros2_options
def list_command(json: bool, **options: Any) -> None:
    """List the topics that have a publisher or a subscription."""
    run_verb(
        lambda node, output: topic_verbs.list_topics(node, output=output, **options), json=json
    )


@topic.command("info")
@topic_argument
@click.option("-v", "--verbose", is_flag=True, help="Print nodes, type hashes, GIDs and QoS too.")
@json_option
@ros2_options
def info_command(topic_name: str, json: bool, verbose: bool) -> None:
    """Print the type of a topic, and its publishers and subscriptions."""
    run_verb(
        lambda node, output: topic_verbs.info(node, topic_name, verbose=verbose, output=output),
        json=json,
    )


add_type_and_find(topic, TOPIC, "msg")


@topic.command("echo")
@topic_argument
@click.argument("message_type", required=False, shell_complete=complete_types_of("topic", "msg"))
@qos_options("sensor_data")
@click.option("--csv", is_flag=True, help="Print all values on one line, separated by commas.")
@click.option(
    "--field", metavar="PATH", shell_complete=complete_fields,
    help="Print one field, such as pose.position or name[0].",
)  # fmt: skip
@click.option("-f", "--full-length", is_flag=True, help="Print arrays and strings in full.")
@click.option(
    "-l",
    "--truncate-length",
    metavar="N",
    type=whole,
    default=128,
    show_default=True,
    help="Print arrays and strings up to this length.",
)
@click.option("--no-arr", is_flag=True, help="Describe arrays instead of printing them.")
@click.option("--no-str", is_flag=True, help="Describe strings instead of printing them.")
@click.option("--flow-style", is_flag=True, help="Print each array in brackets, on one line.")
@click.option("--no-lost-messages", is_flag=True, help="Do not report lost messages.")
@click.option("--raw", is_flag=True, help="Print the serialized bytes.")
@click.option(
    "--filter",
    "filter_text",
    metavar="EXPR",
    help="Print only messages for which this Python expression is true; m is the message.",
)
@click.option(
    "--content-filter",
    metavar="EXPR",
    help="Receive only messages that pass this filter of DDS, such as 'pose.x > 1'.",
)
@click.option("--once", is_flag=True, help="Print one message and end.")
@click.option("--timeout", metavar="N", type=positive, help="End after N seconds.")
@click.option(
    "-i",
    "--include-message-info",
    "with_info",
    is_flag=True,
    help="Print timestamps and sequence numbers too.",
)
@click.option("-c", "--clear", is_flag=True, help="Clear the screen before each message.")
@click.option("-n", "--node-name", help="Name of the subscribing node (default: a hidden one).")
@json_option
@sim_time_option
@interfaces_option
@ros2_options
def echo_command(
    json: bool, node_name: str | None, once: bool, use_sim_time: bool, **options: Any
) -> None:
    """Print each message of a topic, as YAML, CSV or JSON."""
    from aionode.cli._verbs.topic_echo import echo

    qos = qos_from("sensor_data", options)
    if options.pop("full_length"):
        options["truncate_length"] = None
    run_verb(
        lambda node, output: echo(node, qos=qos, once=once, output=output, **options),
        json=json,
        node_name=node_name,
        use_sim_time=use_sim_time,
        endless=not once,
        busy=True,
    )


@topic.command("pub")
@topic_argument
@click.argument("message_type", shell_complete=complete_types_of("topic", "msg"))
@click.argument("values", required=False, shell_complete=complete_values("message"))
@click.option("--stdin", is_flag=True, help="Read the values from standard input.")
@click.option(
    "-r",
    "--rate",
    metavar="N",
    type=hertz,
    default=1.0,
    show_default=True,
    help="Publishing rate, in Hz.",
)
@click.option(
    "-p", "--print", "print_nth", metavar="N", type=whole, default=1,
    help="Print only every N-th message.",
)  # fmt: skip
@click.option("-1", "--once", is_flag=True, help="Publish one message and end.")
@click.option(
    "-t", "--times", metavar="N", type=whole, default=0,
    help="Publish N messages and end.",
)  # fmt: skip
@click.option(
    "-w", "--wait-matching-subscriptions", "wait_for", metavar="N", type=whole,
    help="Wait for N subscriptions first (default: 1 with --once or --times, else 0).",
)  # fmt: skip
@click.option(
    "--max-wait-time-secs", "max_wait_s", metavar="N", type=positive,
    help="Wait at most N seconds for subscriptions.",
)  # fmt: skip
@click.option(
    "--keep-alive", "keep_alive_s", metavar="N", type=seconds, default=0.1,
    show_default=True, help="Keep the node alive for N seconds after the last message.",
)  # fmt: skip
@click.option("-n", "--node-name", help="Name of the publishing node (default: a hidden one).")
@qos_options("default")
@json_option
@sim_time_option
@interfaces_option
@ros2_options
def pub_command(
    json: bool,
    node_name: str | None,
    use_sim_time: bool,
    values: str | None,
    stdin: bool,
    once: bool,
    times: int,
    wait_for: int | None,
    max_wait_s: float | None,
    **options: Any,
) -> None:
    """Publish messages given in YAML, such as '{data: hello}'.

    A Header given as auto and a Time given as now are set to the time of publishing.
    """
    from aionode.cli._verbs.topic_pub import pub

    if once and times:
        raise click.UsageError("Give --once or --times, not both.")
    times = 1 if once else times
    if wait_for is None:
        wait_for = min(times, 1)
    if max_wait_s is not None and wait_for == 0:
        raise click.UsageError(
            "--max-wait-time-secs needs --wait-matching-subscriptions, --once or --times."
        )
    qos = qos_from("default", options)
    text = stdin_text(values, stdin)
    run_verb(
        lambda node, output: pub(
            node,
            values=text,
            times=times,
            wait_for=wait_for,
            max_wait_s=max_wait_s,
            qos=qos,
            output=output,
            **options,
        ),
        json=json,
        node_name=node_name,
        use_sim_time=use_sim_time,
        endless=times == 0,
        busy=True,
        asks=False,
    )


@topic.command("hz")
@click.argument("topic_names", nargs=-1, required=True, shell_complete=complete_names("topic"))
@window_option
@click.option(
    "--filter",
    "filter_text",
    metavar="EXPR",
    help="Count only messages for which this Python expression is true; m is the message.",
)
@click.option("--wall-time", is_flag=True, help="Measure in this machine's time, not in ROS time.")
@json_option
@sim_time_option
@interfaces_option
@ros2_options
def hz_command(
    json: bool, use_sim_time: bool, topic_names: tuple[str, ...], **options: Any
) -> None:
    """Print the rate of messages, once a second."""
    from aionode.cli._verbs.topic_measure import hz

    verb = functools.partial(hz, topic_names=topic_names, **options)
    measure(verb, json=json, use_sim_time=use_sim_time)


@topic.command("bw")
@topic_argument
@click.option(
    "-w", "--window", metavar="N", type=natural, default=100, show_default=True,
    help="Number of messages in the statistics.",
)  # fmt: skip
@json_option
@interfaces_option
@ros2_options
def bw_command(json: bool, **options: Any) -> None:
    """Print the bandwidth of a topic, once a second."""
    from aionode.cli._verbs.topic_measure import bw

    measure(functools.partial(bw, **options), json=json)


@topic.command("delay")
@topic_argument
@window_option
@json_option
@sim_time_option
@interfaces_option
@ros2_options
def delay_command(json: bool, use_sim_time: bool, **options: Any) -> None:
    """Print the age of messages on arrival, by the stamp in their header."""
    from aionode.cli._verbs.topic_measure import delay

    measure(functools.partial(delay, **options), json=json, use_sim_time=use_sim_time)


def measure(verb: Any, *, json: bool, use_sim_time: bool = False) -> None:
    """Run a verb that prints measurements until Ctrl-C."""
    run_verb(
        lambda node, output: verb(node, output=output),
        json=json,
        use_sim_time=use_sim_time,
        endless=True,
        busy=True,
    )
