"""``aionode bag``: record, play, inspect and repair bags."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from aionode.bag.yaml_files import inputs_in, outputs_in
from aionode.cli._nouns.bag.live import burst_command, play_command, record_command
from aionode.cli._nouns.bag.options import (
    TOPICS,
    bag_names,
    names,
    option_from,
    selection_of,
    selection_options,
    spread,
    time_span,
)
from aionode.cli._nouns.bag.replay import diff_command, shrink_command
from aionode.cli._support.files import FilesGroup
from aionode.cli._support.options import json_option
from aionode.cli._support.output import Output
from aionode.errors import escaped

if TYPE_CHECKING:
    from aionode.bag import Bag, TopicInfo

__all__ = ["bag_command"]


@click.group("bag", cls=FilesGroup)
def bag_command() -> None:
    """Record, play, inspect, repair and compare bags."""


bag_command.add_command(diff_command)
bag_command.add_command(shrink_command)
bag_command.add_command(record_command)
bag_command.add_command(play_command)
bag_command.add_command(burst_command)


# Looking


@bag_command.command("info")
@click.argument("path")
@click.option("-s", "--storage", help="Has no effect: the format is detected.")
@click.option("-t", "--topic-name", is_flag=True, help="Print only the names of the topics.")
@click.option("-v", "--verbose", is_flag=True, help="Also print the QoS and type hashes.")
@click.option(
    "--sort", type=click.Choice(["name", "type", "count"]), default="name", help="Sort order."
)
@json_option
def info_command(
    path: str, storage: str, topic_name: bool, verbose: bool, sort: str, json: bool
) -> None:
    """Print the contents of a bag."""
    del storage
    from aionode import bag

    output = Output(json=json)
    with bag.open(path) as opened:
        keys = {"name": lambda t: t.name, "type": lambda t: t.type, "count": count_of}
        topics = sorted(opened.connections, key=keys[sort])
        if topic_name:
            output.items(
                [(escaped(topic.name, one_line=True), {"name": topic.name}) for topic in topics]
            )
            return
        output.item(info_text(opened, topics, verbose=verbose), info_record(opened, topics))


def count_of(topic: TopicInfo) -> int:
    """Return the number of messages of a topic."""
    return topic.message_count


def info_text(opened: Bag, topics: list[TopicInfo], *, verbose: bool) -> str:
    """Return the contents of a bag as text, in rosbag2's layout."""
    lines = [
        f"Files:             {opened.path}",
        f"Duration:          {opened.duration.nanoseconds / 1e9:.9f}s",
        f"Start:             {opened.start_ns / 1e9:.9f}",
        f"End:               {opened.end_ns / 1e9:.9f}",
        f"Messages:          {opened.message_count}",
    ]
    lines.append(f"Lost:              {lost_text(opened)}")
    lines += [f"Missing:           {missing_text(opened)}"] if opened.missing else []
    lines += [f"Custom data:       {key}={value}" for key, value in opened.custom_data.items()]
    for topic in topics:
        lines.append(f"Topic: {topic.name} | Type: {topic.type} | Count: {topic.message_count}")
        if verbose:
            lines.append(f"  Hash: {topic.type_hash or 'none'}")
            lines += [f"  QoS:  {profile}" for profile in topic.qos]
            lines += [f"  QoS:  none: {topic.problem}"] if topic.problem else []
    return "\n".join(escaped(line, one_line=True) for line in lines)


def lost_text(opened: Bag) -> str:
    """Return one line about what the recorder of a bag lost."""
    if opened.losses is None:
        return "unknown: its recorder does not report it"
    return (
        "; ".join(
            f"{name}: {lost.in_transport} in transport, {lost.in_recorder} in recorder"
            for name, lost in sorted(opened.losses.items())
        )
        or "nothing"
    )


def missing_text(opened: Bag) -> str:
    """Return one line about what was written to a bag and is no longer in its files."""
    return "; ".join(f"{name}: {count}" for name, count in sorted(opened.missing.items()))


def info_record(opened: Bag, topics: list[TopicInfo]) -> dict[str, Any]:
    """Return the contents of a bag as a record."""
    return {
        "path": str(opened.path),
        "start_ns": opened.start_ns,
        "end_ns": opened.end_ns,
        "duration_ns": opened.duration.nanoseconds,
        "message_count": opened.message_count,
        "custom_data": opened.custom_data,
        "lost": None
        if opened.losses is None
        else {name: lost._asdict() for name, lost in opened.losses.items()},
        "missing": opened.missing,
        "topics": [
            {
                "name": topic.name,
                "type": topic.type,
                "type_hash": topic.type_hash,
                "message_count": topic.message_count,
                "qos": [str(profile) for profile in topic.qos],
            }
            for topic in topics
        ],
    }


@bag_command.command("list")
@click.argument("what", type=click.Choice(["storage", "converter", "compressor", "decompressor"]))
@json_option
def list_command(what: str, json: bool) -> None:
    """Print the available formats."""
    formats = {
        "storage": ["mcap", "sqlite3"],
        "converter": ["cdr"],
        "compressor": ["zstd", "lz4"],
        "decompressor": ["zstd", "lz4"],
    }
    Output(json=json).items([(name, {"name": name}) for name in formats[what]])


# Copying and repairing

span_options = [
    click.option("--start", help="Start of the piece, from the start of the bag, such as 10s."),
    click.option("--end", help="End of the piece, from the start of the bag, such as 15s."),
    click.option("--duration", help="Duration of the piece, such as 5s."),
]
compression_option = click.option(
    "--compression", type=click.Choice(["zstd", "zstd_small", "lz4", "none"]), default="zstd",
    help="Compression of the chunks.",
)  # fmt: skip


def tell_written(output: Output, out: str, count: int) -> None:
    """Report what was written."""
    output.item(f"{out}: {count} messages", {"path": out, "message_count": count})


@bag_command.command("cut")
@click.argument("path")
@click.argument("out")
@spread(span_options)
@TOPICS
@compression_option
@json_option
def cut_command(path: str, out: str, json: bool, **values: Any) -> None:
    """Copy a piece of a bag: cut IN OUT --start 10s --duration 5s --topics /scan."""
    from aionode import bag

    start, end = time_span(values)
    topics = values["topics"] or None
    count = bag.cut(
        path, out, start=start, end=end, topics=topics, compression=values["compression"]
    )
    tell_written(Output(json=json), out, count)


@bag_command.command("merge")
@click.argument("paths", nargs=-1, required=True)
@click.argument("out")
@compression_option
@json_option
def merge_command(paths: tuple[str, ...], out: str, compression: str, json: bool) -> None:
    """Merge several bags into one, ordered by time."""
    from aionode import bag

    tell_written(Output(json=json), out, bag.merge(paths, out, compression=compression))


@bag_command.command("convert")
@click.argument("paths", nargs=-1)
@names("-i", "--input", "inputs", what="Input bags; the only argument is then the output bag.")
@click.option(
    "--input-options", type=click.Path(exists=True), help="Input bags, as a rosbag2 YAML file."
)
@click.option(
    "-o", "--output-options", type=click.Path(exists=True),
    help="Output bags, as a rosbag2 YAML file, instead of the last argument.",
)  # fmt: skip
@spread(span_options)
@selection_options(playing=True)
@compression_option
@click.option(
    "-b", "--max-bag-size", type=click.IntRange(0), default=0, help="Split files at N bytes."
)
@json_option
def convert_command(paths: tuple[str, ...], json: bool, **values: Any) -> None:
    """Convert bags of any format to one MCAP bag: convert IN... OUT."""
    from aionode import bag

    outputs = []
    if values["output_options"] is not None:
        outputs = option_from(outputs_in, values["output_options"])
    elif paths:
        start, end = time_span(values)
        options = {
            "selection": selection_of(values, everything=True),
            "start": start,
            "end": end,
            "compression": values["compression"],
            "max_bytes": values["max_bag_size"],
        }
        outputs, paths = [(paths[-1], options)], paths[:-1]
    bags = [*paths, *bag_names(values["inputs"]), *option_from(inputs_in, values["input_options"])]
    if not bags or not outputs:
        raise click.UsageError("give the input bags and the output bag: convert IN... OUT")
    for out, options in outputs:
        count = bag.convert(bags, out, **options)
        tell_written(Output(json=json), out, count)


@bag_command.command("reindex")
@click.argument("path")
@click.option("-s", "--storage", help="Has no effect: the format is detected.")
def reindex_command(path: str, storage: str) -> None:
    """Rebuild the metadata of a bag from its files."""
    del storage
    from aionode import bag

    bag.reindex(path)


@bag_command.command("check")
@click.argument("path")
@json_option
def check_command(path: str, json: bool) -> None:
    """Check a bag, and repair what a power cut left.

    The exit status is 1 if messages are missing that the bag once had.
    """
    from aionode import bag

    output = Output(json=json)
    for repair in bag.check(path):
        state = f"repaired, {repair.removed_bytes} bytes removed" if repair.repaired else "ok"
        output.item(f"{repair.file}: {state}, {repair.messages} messages", repair._asdict())
    with bag.open(path) as opened:
        if opened.missing:
            text = f"missing, as metadata.yaml counted: {missing_text(opened)}"
            output.item(escaped(text, one_line=True), {"missing": opened.missing})
            raise click.exceptions.Exit(1)
