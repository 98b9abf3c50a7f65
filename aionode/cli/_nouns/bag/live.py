"""``aionode bag record``, ``play`` and ``burst``: rosbag2's options, keys and progress."""

from __future__ import annotations

import asyncio
from contextlib import asynccontextmanager
from typing import TYPE_CHECKING, Any

import click

from aionode._process.concurrency import checkpoint
from aionode.bag.yaml_files import PRESETS, chunk_compression, static_topics_in
from aionode.cli._nouns.bag.options import (
    bag_names,
    checked_selection,
    names,
    option_from,
    output_folder,
    overrides,
    selection_of,
    selection_options,
    spread,
)
from aionode.cli._nouns.bag.terminal import (
    DOWN,
    RIGHT,
    SPACE,
    UP,
    keys_pressed,
    progress_shown,
)
from aionode.cli._support.options import interfaces_option, json_option, positive, seconds
from aionode.cli._support.output import Output
from aionode.cli._support.session import run_until_stopped
from aionode.clock import Duration

if TYPE_CHECKING:
    from collections.abc import AsyncIterator, Callable, Coroutine, Sequence

    from aionode.bag import Player, Recorder
    from aionode.node import Node

__all__ = ["burst_command", "play_command", "record_command"]

MIB = 1 << 20
RATE_STEP = 0.1
LEVELS = ["debug", "info", "warn", "error", "fatal"]
NO_EFFECT = "Accepted for compatibility with rosbag2; has no effect."

common_options = [
    click.option("--log-level", type=click.Choice(LEVELS), help="Log level."),
    click.option("--disable-keyboard-controls", is_flag=True, help="Disable keyboard controls."),
    click.option(
        "--progress-bar-update-rate", type=click.IntRange(-1), default=3,
        help="Update rate of the progress line, in Hz; 0 disables it.",
    ),
    click.option("--progress-bar-separation-lines", type=int, help=NO_EFFECT),
    click.option("--storage-config-file", type=click.Path(exists=True), help="YAML file."),
    click.option("--qos-profile-overrides-path", type=click.Path(exists=True), help="YAML file."),
    json_option,
]  # fmt: skip


def run(work: Coroutine[None, None, int | None]) -> None:
    """Run a coroutine until it returns or a signal arrives, then end the command."""
    from aionode.runner import best_loop_factory

    status = run_until_stopped(work, loop_factory=best_loop_factory())
    raise click.exceptions.Exit(status or 0)


def set_level(node: Node, level: str | None) -> None:
    """Set a node's log level, if one is given."""
    from aionode.logging import LoggingSeverity

    if level is not None:
        node.get_logger().set_level(LoggingSeverity[level.upper()])


# Recording


@click.command("record")
@interfaces_option
@selection_options(playing=False)
@click.option("-o", "--output", "out", help="Output folder; default: named after the time.")
@click.option(
    "-s",
    "--storage",
    type=click.Choice(["mcap", "sqlite3"]),
    default="mcap",
    help="Storage format; sqlite3 can only be read.",
)
@click.option(
    "-b", "--max-bag-size", type=click.IntRange(0), default=0, help="Split files at N bytes."
)
@click.option(
    "-d", "--max-bag-duration", type=click.FloatRange(0), default=0, help="Split files at N s."
)
@click.option("--max-bag-files", type=click.IntRange(0), default=0, help="Number of files to keep.")
@click.option(
    "--max-cache-size",
    type=click.IntRange(0),
    default=100 * MIB,
    help="Size of the write queue or of a snapshot, in bytes.",
)
@click.option(
    "--max-cache-duration",
    type=click.FloatRange(0),
    default=0,
    help="Duration of a snapshot, in seconds; 0 for no limit.",
)
@click.option("--snapshot-mode", is_flag=True, help="Only write on request, as snapshots.")
@names(
    "--repeat-transient-local",
    what="TOPIC[=DEPTH]: latched topics whose last messages are repeated in every file.",
)
@click.option(
    "--repeat-all-transient-local",
    type=click.IntRange(0),
    is_flag=False,
    flag_value=0,
    help="Repeat all latched topics, with this many messages each (the default).",
)
@click.option(
    "--static-topics-path",
    type=click.Path(exists=True),
    help="YAML file of topics and types to record from the start.",
)
@click.option("--start-paused", is_flag=True, help="Start paused; SPACE resumes.")
@click.option("--no-discovery", is_flag=True, help="Only topics that exist at the start.")
@click.option(
    "--include-unpublished-topics", is_flag=True, help="Also topics with subscriptions only."
)
@click.option("--ignore-leaf-topics", is_flag=True, help="Skip topics without subscriptions.")
@click.option("--node-name", default="rosbag2_recorder", help="Name of the node.")
@click.option(
    "--causes",
    is_flag=True,
    help="Also what `aionode why --from` needs, from processes with AIONODE_CAUSES=1.",
)
@click.option("--custom-data", multiple=True, help="KEY=VALUE pairs for the metadata.")
@click.option(
    "--compression-format",
    type=click.Choice(["zstd", "lz4", "none"]),
    default="zstd",
    help="Compression of the chunks.",
)
@click.option(
    "--compression-mode",
    type=click.Choice(["none", "file", "message"]),
    default="none",
    help="Only none is supported: chunks are compressed, so files stay readable.",
)
@click.option(
    "--storage-preset-profile",
    type=click.Choice(list(PRESETS)),
    help="rosbag2's names for compression settings of chunks.",
)
@click.option(
    "--stats_max_publishing_rate",
    "stats_hz",
    type=click.FloatRange(0),
    default=1.0,
    help="Maximum rate at which losses are published, in Hz.",
)
@click.option("--use-sim-time", is_flag=True, help="Use the time of /clock (simulated time).")
@click.option("-f", "--serialization-format", type=click.Choice(["cdr"]), help=NO_EFFECT)
@click.option("-p", "--polling-interval", type=int, help=NO_EFFECT)
@click.option("--compression-queue-size", type=int, help=NO_EFFECT)
@click.option("--compression-threads", type=int, help=NO_EFFECT)
@click.option("--compression-threads-priority", type=int, help=NO_EFFECT)
@click.argument("named", metavar="[TOPIC]...", nargs=-1)
@spread(common_options)
def record_command(**values: Any) -> None:
    """Record topics until Ctrl-C. SPACE pauses and resumes.

    A TOPIC has the same effect as one of --topics.
    """
    from aionode.bag import Recorder
    from aionode.engine.context import Context

    options = recorder_options(values)
    out, output = values["out"] or output_folder(), Output(json=values["json"])
    recorder = Recorder(out, context=Context(), **options)

    async def record() -> None:
        try:
            async with recorder, shown(values, lambda: recording_text(recorder), record_keys):
                set_level(recorder.node, values["log_level"])
                recorder.node.get_logger().info(f"Recording to {out}; press Ctrl-C to stop")
                await recorder.failed()
        finally:
            if output.json:
                output.item("", recorded_record(recorder))

    def toggle() -> None:
        if recorder.paused:
            recorder.resume()
        else:
            recorder.pause()

    record_keys = {SPACE: toggle}
    run(record())


def recorder_options(values: dict[str, Any]) -> dict[str, Any]:
    """Return the recorder's settings.

    Raises:
        click.UsageError: options exclude each other, or ask for a format that cannot be written.
    """
    selection = checked_selection(values | {"topics": (*values["topics"], *values["named"])})
    if values["use_sim_time"] and values["no_discovery"]:
        raise click.UsageError("--use-sim-time and --no-discovery cannot be combined")
    if values["storage"] != "mcap":
        raise click.UsageError("--storage sqlite3: aionode only reads it; it writes mcap")
    if values["compression_mode"] != "none":
        raise click.UsageError(
            f"--compression-mode {values['compression_mode']}: only chunks are compressed; use "
            "--compression-format"
        )
    latched: dict[str, int] = {
        f"/{name.removeprefix('/')}": int(depth or 0)
        for name, _, depth in (option.partition("=") for option in values["repeat_transient_local"])
    }
    if values["repeat_all_transient_local"] is not None:
        latched = {"*": values["repeat_all_transient_local"], **latched}
    return {
        "selection": selection,
        "node_name": values["node_name"],
        "compression": option_from(
            chunk_compression,
            values["storage_preset_profile"],
            values["storage_config_file"],
            values["compression_format"],
        ),
        "max_bytes": values["max_bag_size"],
        "max_duration_sec": values["max_bag_duration"],
        "max_files": values["max_bag_files"],
        "cache_bytes": values["max_cache_size"],
        "cache_duration_sec": values["max_cache_duration"],
        "snapshot": values["snapshot_mode"],
        "repeat_latched": latched or True,
        "discovery": not values["no_discovery"],
        "include_unpublished": values["include_unpublished_topics"],
        "ignore_leaf": values["ignore_leaf_topics"],
        "static_topics": option_from(static_topics_in, values["static_topics_path"]),
        "qos": overrides(values["qos_profile_overrides_path"]),
        "use_sim_time": values["use_sim_time"],
        "start_paused": values["start_paused"],
        "loss_report_hz": values["stats_hz"],
        "causes": values["causes"],
        "custom_data": dict(item.partition("=")[::2] for item in values["custom_data"]),
    }


def recording_text(recorder: Recorder) -> str:
    """Return the progress line of a recording."""
    stats = recorder.stats.values()
    recorded = sum(topic.recorded for topic in stats)
    lost = sum(topic.lost_in_transport + topic.lost_in_recorder for topic in stats)
    state = "Paused   " if recorder.paused else "Recording"
    return f"{state} {recorded} messages of {len(stats)} topics, {lost} lost"


def recorded_record(recorder: Recorder) -> dict[str, Any]:
    """Return a record of what was recorded and what was lost."""
    stats = recorder.stats
    return {
        "path": str(recorder.path),
        "recorded": sum(topic.recorded for topic in stats.values()),
        "lost_in_transport": sum(topic.lost_in_transport for topic in stats.values()),
        "lost_in_recorder": sum(topic.lost_in_recorder for topic in stats.values()),
        "topics": [{"name": name, **topic._asdict()} for name, topic in sorted(stats.items())],
    }


@asynccontextmanager
async def shown(
    values: dict[str, Any], text: Callable[[], str], actions: dict[str, Any]
) -> AsyncIterator[None]:
    """Handle keys and show a progress line inside the block."""
    with keys_pressed(actions, wanted=not values["disable_keyboard_controls"]):
        async with progress_shown(text, values["progress_bar_update_rate"]):
            yield


# Playing


play_options = [
    click.argument("bags", nargs=-1),
    names("-i", "--input", "inputs", what="Input bags; several are merged."),
    click.option("-s", "--storage", help="Has no effect: the format is detected."),
    selection_options(playing=True),
    click.option("--start-offset", type=click.FloatRange(0), default=0.0, help="Seconds to skip."),
    names("-m", "--remap", what="OLD:=NEW topic names."),
    click.option("--read-ahead-queue-size", type=int, help=NO_EFFECT),
    spread(common_options),
]


def player_options(values: dict[str, Any]) -> tuple[list[str], dict[str, Any]]:
    """Return the bags and the settings of a player."""
    paths = [*values["bags"], *bag_names(values["inputs"])]
    if not paths:
        raise click.UsageError("give a bag, or several with --input")
    return paths, {
        "selection": selection_of(values, everything=True),
        "start_offset": Duration(seconds=values["start_offset"]),
        "remap": dict(item.partition(":=")[::2] for item in values["remap"]),
        "qos": overrides(values["qos_profile_overrides_path"]),
    }


@click.command("play")
@interfaces_option
@spread(play_options)
@click.option("-r", "--rate", type=positive, default=1.0, help="Speed.")
@click.option("-l", "--loop", is_flag=True, help="Start over at the end.")
@click.option("-p", "--start-paused", is_flag=True, help="Begin paused.")
@click.option("-d", "--delay", type=seconds, default=0.0, help="Seconds before the first message.")
@click.option("--playback-duration", type=click.FloatRange(0), help="Duration to play, in seconds.")
@click.option(
    "--playback-until-sec", type=float, help="Recorded time at which to stop, in seconds."
)
@click.option("--playback-until-nsec", type=int, help="The same, in nanoseconds.")
@click.option(
    "--clock",
    "clock_hz",
    type=positive,
    is_flag=False,
    flag_value=40.0,
    help="Publish /clock at this rate, in Hz (40 if no number is given).",
)
@names("--clock-topics", what="Publish /clock with each message of these topics.")
@click.option("--clock-topics-all", is_flag=True, help="Publish /clock with each message.")
@click.option(
    "--wait-for-all-acked",
    type=click.IntRange(0),
    metavar="MS",
    help="At the end, wait up to N ms for delivery; 0 for no limit.",
)
@click.option(
    "--publish-service-requests", is_flag=True, help="Replay service requests as a client."
)
@click.option("--send-actions-as-client", is_flag=True, help="Replay action goals as a client.")
@click.option(
    "--service-requests-source",
    type=click.Choice(["service_introspection", "client_introspection"]),
    default="service_introspection",
    help="Side whose service events are used for requests.",
)
@click.option(
    "--message-order",
    type=click.Choice(["received", "sent"]),
    default="received",
    help="Time by which messages are ordered and played.",
)
@click.option("--disable-loan-message", is_flag=True, help=NO_EFFECT)
def play_command(**values: Any) -> None:
    """Play bags in order of time.

    SPACE pauses and resumes, the right arrow plays the next message, up and down change the rate.
    """
    from aionode.bag import Player
    from aionode.clock import Time
    from aionode.engine.context import Context

    paths, options = player_options(values)
    length, until_ns = values["playback_duration"], values["playback_until_nsec"]
    if values["playback_until_sec"] is not None:
        until_ns = int(values["playback_until_sec"] * 1e9)
    acked_ms = values["wait_for_all_acked"]
    asks = {"service": "publish_service_requests", "action": "send_actions_as_client"}
    clock_topics = [f"/{name.removeprefix('/')}" for name in values["clock_topics"]]
    player = Player(
        paths,
        rate=values["rate"],
        loop=values["loop"],
        start_paused=values["start_paused"],
        delay_sec=values["delay"],
        duration=None if length is None else Duration(seconds=length),
        until=None if until_ns is None else Time(nanoseconds=until_ns),
        clock_hz=values["clock_hz"] or 0.0,
        clock_topics=["*"] if values["clock_topics_all"] else clock_topics,
        in_order_sent=values["message_order"] == "sent",
        send_requests=[kind for kind, option in asks.items() if values[option]],
        requests_source=values["service_requests_source"],
        wait_acked_sec=None if acked_ms is None else acked_ms / 1000,
        context=Context(),
        **options,
    )

    async def play() -> None:
        async with player, asyncio.TaskGroup() as tasks:
            set_level(player.node, values["log_level"])
            async with shown(values, lambda: playing_text(player), play_keys(player, tasks)):
                await player.play()

    run(telling(play(), player, paths, json=values["json"]))


@click.command("burst")
@interfaces_option
@spread(play_options)
@click.option(
    "-n", "--num-messages", type=click.IntRange(0), default=0, help="Number of messages; 0 for all."
)
def burst_command(**values: Any) -> None:
    """Play messages as fast as possible."""
    from aionode.bag import Player
    from aionode.engine.context import Context

    paths, options = player_options(values)
    player = Player(paths, start_paused=True, context=Context(), **options)

    async def burst() -> None:
        async with player, asyncio.TaskGroup() as tasks:
            set_level(player.node, values["log_level"])
            tasks.create_task(player.play())
            await checkpoint()  # it is playing from here on
            await player.burst(values["num_messages"])
            player.stop()

    run(telling(burst(), player, paths, json=values["json"]))


async def telling(
    work: Coroutine[None, None, None], player: Player, paths: Sequence[str], *, json: bool
) -> None:
    """Play, and print a record of it at the end, however it ends."""
    try:
        await work
    finally:
        if json:
            Output(json=True).item("", {"paths": list(paths), "played": player.played})


def play_keys(player: Player, tasks: asyncio.TaskGroup) -> dict[str, Any]:
    """Return what each key does while a bag is playing."""

    def change_rate(step: float) -> None:
        rate = round(player.rate + step, 6)
        if rate > 0:
            player.set_rate(rate)

    return {
        SPACE: player.toggle_paused,
        RIGHT: lambda: tasks.create_task(player.play_next()),
        UP: lambda: change_rate(RATE_STEP),
        DOWN: lambda: change_rate(-RATE_STEP),
    }


def playing_text(player: Player) -> str:
    """Return the progress line of a player."""
    start_ns = player.start.nanoseconds
    at = (player.time.nanoseconds - start_ns) / 1e9
    length = (player.end.nanoseconds - start_ns) / 1e9
    state = "Paused " if player.paused else "Playing"
    return f"{state} {min(at, length):.1f} of {length:.1f} s, {player.rate:g} times as fast"
