"""``aionode bag``: record, play, inspect and repair bags."""

from __future__ import annotations

import asyncio
from typing import TYPE_CHECKING, Any

import click

from aionode._concurrency import checkpoint
from aionode.cli._nouns.bag_options import (
    TOPICS,
    checked_selection,
    output_folder,
    overrides,
    selection_of,
    selection_options,
    spread,
    time_span,
)
from aionode.cli._nouns.bag_replay import diff_command, shrink_command
from aionode.cli._support.options import json_option, positive, seconds, sim_time_option
from aionode.cli._support.output import Output
from aionode.cli._support.session import run_until_stopped
from aionode.clock import Duration
from aionode.errors import CommandError

if TYPE_CHECKING:
    from collections.abc import Coroutine

    from aionode.bag import Bag, TopicInfo

__all__ = ["bag_command"]

GIB = 1 << 30
MIB = 1 << 20


class BagGroup(click.Group):
    """A group whose commands name the file that is missing or cannot be read, in one line."""

    def invoke(self, ctx: click.Context) -> Any:
        """Run a command.

        Raises:
            CommandError: a file cannot be read or written.
        """
        try:
            return super().invoke(ctx)
        except BrokenPipeError:
            raise
        except OSError as error:
            raise CommandError(str(error)) from error


@click.group("bag", cls=BagGroup)
def bag_command() -> None:
    """Record, play, inspect, repair and compare bags."""


bag_command.add_command(diff_command)
bag_command.add_command(shrink_command)


def run(work: Coroutine[None, None, int | None]) -> None:
    """Run a coroutine until it returns or a signal comes, and end the command."""
    from aionode.runner import best_loop_factory

    status = run_until_stopped(work, loop_factory=best_loop_factory())
    raise click.exceptions.Exit(status or 0)


# Recording and playing


@bag_command.command("record")
@selection_options(playing=False)
@click.option("-o", "--output", "out", help="The folder; its name has the time by default.")
@click.option("-b", "--max-bag-size", type=click.IntRange(0), default=0, help="Bytes of a file.")
@click.option(
    "-d", "--max-bag-duration", type=click.FloatRange(0), default=0, help="Seconds of a file."
)
@click.option("--max-bag-files", type=click.IntRange(0), default=0, help="How many files to keep.")
@click.option(
    "--max-cache-size", type=click.IntRange(0), default=100 * MIB, help="Bytes that may wait."
)
@click.option("--snapshot-mode", is_flag=True, help="Keep messages until a snapshot is asked for.")
@click.option("--start-paused", is_flag=True, help="Begin paused.")
@click.option(
    "--no-discovery", is_flag=True, help="Record only topics that are there at the start."
)
@click.option("--include-unpublished-topics", is_flag=True, help="Also those with readers only.")
@click.option("--qos-profile-overrides-path", type=click.Path(exists=True), help="QoS, as YAML.")
@click.option("--node-name", default="rosbag2_recorder", help="The name of the node.")
@click.option("--custom-data", multiple=True, help="KEY=VALUE, for the metadata.")
@click.option(
    "--compression-format", type=click.Choice(["zstd", "lz4", "none"]), default="zstd",
    help="The compression of chunks.",
)  # fmt: skip
@sim_time_option
def record_command(**values: Any) -> None:
    """Record topics, until Ctrl-C."""
    from aionode.bag import Recorder

    selection = checked_selection(values)
    if values["use_sim_time"] and values["no_discovery"]:
        raise click.UsageError("--use-sim-time and --no-discovery exclude each other")
    custom = dict(item.partition("=")[::2] for item in values["custom_data"])
    recorder_options = {
        "selection": selection,
        "node_name": values["node_name"],
        "compression": values["compression_format"],
        "max_bytes": values["max_bag_size"],
        "max_duration_sec": values["max_bag_duration"],
        "max_files": values["max_bag_files"],
        "cache_bytes": values["max_cache_size"],
        "snapshot": values["snapshot_mode"],
        "discovery": not values["no_discovery"],
        "include_unpublished": values["include_unpublished_topics"],
        "qos": overrides(values["qos_profile_overrides_path"]),
        "use_sim_time": values["use_sim_time"],
        "start_paused": values["start_paused"],
        "custom_data": custom,
    }
    out = values["out"] or output_folder()

    async def record() -> None:
        async with Recorder(out, **recorder_options) as recorder:
            recorder.node.get_logger().info(f"Recording to {out}; Ctrl-C ends it")
            await recorder.failed()

    run(record())


play_options = [
    click.argument("bags", nargs=-1),
    click.option("-i", "--input", "inputs", multiple=True, help="A bag; several are merged."),
    selection_options(playing=True),
    click.option("--start-offset", type=click.FloatRange(0), default=0.0, help="Seconds to skip."),
    click.option("-m", "--remap", multiple=True, help="OLD:=NEW, for the name of a topic."),
    click.option("--qos-profile-overrides-path", type=click.Path(exists=True), help="As YAML."),
]


def player_options(values: dict[str, Any]) -> tuple[list[str], dict[str, Any]]:
    """Return the bags and the settings of a player."""
    paths = [*values["bags"], *values["inputs"]]
    if not paths:
        raise click.UsageError("give a bag, or several with --input")
    remap = dict(item.partition(":=")[::2] for item in values["remap"])
    return paths, {
        "selection": selection_of(values, everything=True),
        "start_offset": Duration(seconds=values["start_offset"]),
        "remap": remap,
        "qos": overrides(values["qos_profile_overrides_path"]),
    }


@bag_command.command("play")
@spread(play_options)
@click.option("-r", "--rate", type=positive, default=1.0, help="How fast.")
@click.option("-l", "--loop", is_flag=True, help="Begin again at the end.")
@click.option("-p", "--start-paused", is_flag=True, help="Begin paused.")
@click.option("-d", "--delay", type=seconds, default=0.0, help="Seconds before the first message.")
@click.option("--playback-duration", type=click.FloatRange(0), help="How many seconds to play.")
@click.option("--playback-until-sec", type=float, help="The recorded time of the end, in seconds.")
@click.option("--playback-until-nsec", type=int, help="The same in nanoseconds.")
@click.option(
    "--clock", "clock_hz", type=positive, is_flag=False, flag_value=40.0,
    help="Publish /clock so often, in Hz; 40 if no number is given.",
)  # fmt: skip
def play_command(**values: Any) -> None:
    """Play bags, in order of time."""
    from aionode.bag import Player
    from aionode.clock import Time

    paths, options = player_options(values)
    length, until_ns = values["playback_duration"], values["playback_until_nsec"]
    if values["playback_until_sec"] is not None:
        until_ns = int(values["playback_until_sec"] * 1e9)

    async def play() -> None:
        async with Player(
            paths,
            rate=values["rate"],
            loop=values["loop"],
            start_paused=values["start_paused"],
            delay_sec=values["delay"],
            duration=None if length is None else Duration(seconds=length),
            until=None if until_ns is None else Time(nanoseconds=until_ns),
            clock_hz=values["clock_hz"] or 0.0,
            **options,
        ) as player:
            await player.play()

    run(play())


@bag_command.command("burst")
@spread(play_options)
@click.option("-n", "--num-messages", type=click.IntRange(0), default=0, help="0 for all.")
def burst_command(**values: Any) -> None:
    """Play messages as fast as possible."""
    from aionode.bag import Player

    paths, options = player_options(values)

    async def burst() -> None:
        async with (
            Player(paths, start_paused=True, **options) as player,
            asyncio.TaskGroup() as tasks,
        ):
            tasks.create_task(player.play())
            await checkpoint()  # it plays from now on
            await player.burst(values["num_messages"])
            player.stop()

    run(burst())


# Looking


@bag_command.command("info")
@click.argument("path")
@click.option("-t", "--topic-name", is_flag=True, help="Print only the names of the topics.")
@click.option("-v", "--verbose", is_flag=True, help="Also the QoS and hashes of the topics.")
@click.option("--sort", type=click.Choice(["name", "type", "count"]), default="name", help="Order.")
@json_option
def info_command(path: str, topic_name: bool, verbose: bool, sort: str, json: bool) -> None:
    """Print what a bag has."""
    from aionode import bag

    output = Output(json=json)
    with bag.open(path) as found:
        keys = {"name": lambda t: t.name, "type": lambda t: t.type, "count": count_of}
        topics = sorted(found.connections, key=keys[sort])
        if topic_name:
            output.items([(each.name, {"name": each.name}) for each in topics])
            return
        output.item(info_text(found, topics, verbose=verbose), info_record(found, topics))


def count_of(topic: TopicInfo) -> int:
    """Return how many messages a topic has."""
    return topic.message_count


def info_text(found: Bag, topics: list[TopicInfo], *, verbose: bool) -> str:
    """Return what a bag has, as rosbag2 prints it."""
    lines = [
        f"Files:             {found.path}",
        f"Duration:          {found.duration.nanoseconds / 1e9:.9f}s",
        f"Start:             {found.start_ns / 1e9:.9f}",
        f"End:               {found.end_ns / 1e9:.9f}",
        f"Messages:          {found.message_count}",
    ]
    lines.append(f"Lost:              {lost_text(found)}")
    lines += [f"Custom data:       {key}={value}" for key, value in found.custom_data.items()]
    for each in topics:
        lines.append(f"Topic: {each.name} | Type: {each.type} | Count: {each.message_count}")
        if verbose:
            lines.append(f"  Hash: {each.type_hash or 'none'}")
            lines += [f"  QoS:  {profile}" for profile in each.qos]
    return "\n".join(lines)


def lost_text(found: Bag) -> str:
    """Return in one line what the recorder of a bag has lost."""
    if found.losses is None:
        return "not known: its recorder does not say"
    return (
        "; ".join(
            f"{name}: {lost.in_transport} in transport, {lost.in_recorder} in recorder"
            for name, lost in sorted(found.losses.items())
        )
        or "nothing"
    )


def info_record(found: Bag, topics: list[TopicInfo]) -> dict[str, Any]:
    """Return what a bag has, as a record."""
    return {
        "path": str(found.path),
        "start_ns": found.start_ns,
        "end_ns": found.end_ns,
        "duration_ns": found.duration.nanoseconds,
        "message_count": found.message_count,
        "custom_data": found.custom_data,
        "lost": None
        if found.losses is None
        else {name: lost._asdict() for name, lost in found.losses.items()},
        "topics": [
            {
                "name": each.name,
                "type": each.type,
                "type_hash": each.type_hash,
                "message_count": each.message_count,
                "qos": [str(profile) for profile in each.qos],
            }
            for each in topics
        ],
    }


@bag_command.command("list")
@click.argument("what", type=click.Choice(["storage", "converter", "compressor", "decompressor"]))
@json_option
def list_command(what: str, json: bool) -> None:
    """Print which formats there are."""
    formats = {
        "storage": ["mcap", "sqlite3"],
        "converter": ["cdr"],
        "compressor": ["zstd", "lz4"],
        "decompressor": ["zstd", "lz4"],
    }
    Output(json=json).items([(name, {"name": name}) for name in formats[what]])


# Copying and repairing

span_options = [
    click.option("--start", help="Where to begin, after the start of the bag: 10s."),
    click.option("--end", help="Where to end, after the start of the bag: 15s."),
    click.option("--duration", help="How long, from where it begins: 5s."),
]
compression_option = click.option(
    "--compression", type=click.Choice(["zstd", "lz4", "none"]), default="zstd",
    help="The compression of chunks.",
)  # fmt: skip


def tell_written(output: Output, out: str, count: int) -> None:
    """Say what was written."""
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
    """Copy several bags into one, in order of time."""
    from aionode import bag

    tell_written(Output(json=json), out, bag.merge(paths, out, compression=compression))


@bag_command.command("convert")
@click.argument("paths", nargs=-1, required=True)
@click.argument("out")
@spread(span_options)
@selection_options(playing=True)
@compression_option
@click.option("-b", "--max-bag-size", type=click.IntRange(0), default=0, help="Bytes of a file.")
@json_option
def convert_command(paths: tuple[str, ...], out: str, json: bool, **values: Any) -> None:
    """Write bags of any kind anew, as one MCAP bag."""
    from aionode import bag

    start, end = time_span(values)
    count = bag.convert(
        paths,
        out,
        selection=selection_of(values, everything=True),
        start=start,
        end=end,
        compression=values["compression"],
        max_bytes=values["max_bag_size"],
    )
    tell_written(Output(json=json), out, count)


@bag_command.command("reindex")
@click.argument("path")
def reindex_command(path: str) -> None:
    """Write the metadata of a bag anew, from its files."""
    from aionode import bag

    bag.reindex(path)


@bag_command.command("check")
@click.argument("path")
@json_option
def check_command(path: str, json: bool) -> None:
    """Check a bag, and repair what a power cut left."""
    from aionode import bag

    output = Output(json=json)
    for each in bag.check(path):
        state = f"repaired, {each.removed_bytes} bytes removed" if each.repaired else "ok"
        output.item(f"{each.file}: {state}, {each.messages} messages", each._asdict())
